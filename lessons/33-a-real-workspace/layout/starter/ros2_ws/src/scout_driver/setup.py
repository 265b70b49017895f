from setuptools import setup

setup(
    name="scout_driver",
    version="0.1.0",
    packages=["scout_driver"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/scout_driver"]),
        ("share/scout_driver", ["package.xml"]),
    ],
    # the name of the program = its module:its function
    entry_points={"console_scripts": ["cruise = scout_driver.drive:main"]},
)
