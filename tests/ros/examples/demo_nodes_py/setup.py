from setuptools import setup

setup(
    name="demo_nodes_py",
    version="0.1.0",
    packages=["demo_nodes_py"],
    entry_points={
        "console_scripts": [
            "add_two_ints_client = demo_nodes_py.add_two_ints_client:main",
            "add_two_ints_client_async = demo_nodes_py.add_two_ints_client_async:main",
            "add_two_ints_server = demo_nodes_py.add_two_ints_server:main",
            "async_param_client = demo_nodes_py.async_param_client:main",
            "event_listener = demo_nodes_py.event_listener:main",
            "introspection = demo_nodes_py.introspection:main",
            "listener = demo_nodes_py.listener:main",
            "listener_qos = demo_nodes_py.listener_qos:main",
            "listener_serialized = demo_nodes_py.listener_serialized:main",
            "matched_event_detect = demo_nodes_py.matched_event_detect:main",
            "param1_setter = demo_nodes_py.param1_setter:main",
            "parameter_blackboard = demo_nodes_py.parameter_blackboard:main",
            "set_parameters_callback = demo_nodes_py.set_parameters_callback:main",
            "talker = demo_nodes_py.talker:main",
            "talker_qos = demo_nodes_py.talker_qos:main",
            "use_logger_service = demo_nodes_py.use_logger_service:main",
        ],
    },
)
