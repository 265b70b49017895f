from glob import glob

from setuptools import find_packages, setup

setup(
    name='heater',
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/heater']),
        ('share/heater', ['package.xml']),
        ('share/heater/launch', glob('launch/*.launch.py')),
    ],
    entry_points={'console_scripts': [
        'thermometer = heater.thermometer:main',
        'listener = heater.listener:main',
    ]},
)
