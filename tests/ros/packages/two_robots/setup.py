from glob import glob

from setuptools import setup

package_name = 'two_robots'
submodules = [package_name + '/driving']

setup(
    name=package_name,
    version='0.0.0',
    packages=[package_name] + submodules,
    data_files=[
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch/', glob('launch/*launch*')),
        ('share/' + package_name + '/world/', glob('world/*')),
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={
        'console_scripts': [
            'pair = two_robots.__init__:main',
            f'{"learner"} = two_robots.learner:main',
        ],
    },
)
