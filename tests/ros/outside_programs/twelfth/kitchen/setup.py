from setuptools import setup

setup(
    name='kitchen',
    version='0.0.1',
    packages=['kitchen'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/kitchen']),
        ('share/kitchen', ['package.xml']),
        ('share/kitchen/config', ['config/oven.yaml']),
    ],
    install_requires=['setuptools'],
    entry_points={
        'console_scripts': [
            'oven = kitchen.oven:main',
            'cook = kitchen.cook:main',
        ],
    },
)
