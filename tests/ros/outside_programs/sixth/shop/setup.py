import os
from glob import glob
from setuptools import find_packages, setup
package_name = "shop"
setup(name=package_name, version="0.0.1", packages=find_packages(exclude=["test"]),
      data_files=[("share/ament_index/resource_index/packages", ["resource/" + package_name]),
                  ("share/" + package_name, ["package.xml"]),
                  (os.path.join("share", package_name, "launch"), glob("launch/*")),
                  (os.path.join("share", package_name, "config"), glob("config/*.yaml"))],
      install_requires=["setuptools"], zip_safe=True, maintainer="a", maintainer_email="a@b.c", description="c", license="Apache-2.0",
      entry_points={"console_scripts": ["talker = shop.talker:main", "listener = shop.listener:main"]})
