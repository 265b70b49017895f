from setuptools import find_packages, setup

package_name = "course_py"

setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={
        "console_scripts": [
            "reading_publisher = course_py.reading_publisher:main",
            "area_server = course_py.area_server:main",
            "count_server = course_py.count_server:main",
            "camera = course_py.camera:main",
            "tour = course_py.tour:main",
        ],
    },
)
