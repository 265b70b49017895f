from setuptools import setup

setup(
    name="scout_old",
    version="0.1.0",
    packages=["scout_old"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/scout_old"]),
        ("share/scout_old", ["package.xml"]),
    ],
)
