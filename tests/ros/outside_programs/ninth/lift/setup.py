from setuptools import find_packages, setup

setup(
    name="lift",
    version="0.0.1",
    packages=find_packages(),
    data_files=[("share/lift", ["package.xml", "lift.launch.xml"])],
    entry_points={"console_scripts": ["lift = lift.lift_node:main", "passenger = lift.passenger:main"]},
)
