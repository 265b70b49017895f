from glob import glob

from setuptools import setup

setup(
    name="convoy",
    version="0.1.0",
    packages=["convoy"],
    # What is installed besides the code. A file that is not listed is
    # not found once the package is built.
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/convoy"]),
        ("share/convoy", ["package.xml"]),
        ("share/convoy/launch", glob("*.launch.py")),
        ("share/convoy/world", glob("world/*")),
    ],
    # The programs: what launch files call by the name on the left.
    entry_points={"console_scripts": ["cruise = convoy.cruise:main"]},
)
