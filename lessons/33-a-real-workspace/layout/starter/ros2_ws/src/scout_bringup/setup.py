from glob import glob

from setuptools import setup

setup(
    name="scout_bringup",
    version="0.1.0",
    packages=["scout_bringup"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/scout_bringup"]),
        ("share/scout_bringup", ["package.xml"]),
        ("share/scout_bringup/launch", glob("launch/*")),
    ],
)
