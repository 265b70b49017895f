import os
from glob import glob
from setuptools import find_packages, setup

package_name = 'odom_recorder'

setup(
    name=package_name,
    version='0.0.1',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*.launch.*')),
        (os.path.join('share', package_name, 'config'), glob('config/*.yaml')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={
        'console_scripts': [
            'recorder = odom_recorder.recorder:main',
            'mover = odom_recorder.mover:main',
            'task = odom_recorder.task:main',
        ],
    },
)
