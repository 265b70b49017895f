from setuptools import setup

setup(
    name="scout_tools",
    version="0.1.0",
    packages=["scout_tools"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/scout_tools"]),
        ("share/scout_tools", ["package.xml"]),
    ],
)
