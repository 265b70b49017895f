"""Every public callable of rclpy that packages use is there, with its parameters' names, order and defaults.

The table is a list of facts about rclpy's branches humble, jazzy and rolling. A parameter in brackets exists on
newer branches only. ``self`` and ``cls`` are left out.
"""

from __future__ import annotations

import importlib
import inspect
from typing import Any

import pytest

from tests.cases import every_case

pytestmark = pytest.mark.usefixtures("import_names")

NODE = (
    "node_name, *, context=None, cli_args=None, namespace=None, use_global_arguments=True, enable_rosout=True, "
    "start_parameter_services=True, parameter_overrides=None, allow_undeclared_parameters=False, "
    "automatically_declare_parameters_from_overrides=False, [enable_logger_service=False]"
)

TABLE = f"""
rclpy init(*, args=None, context=None, domain_id=None, signal_handler_options=None)
rclpy shutdown(*, context=None, [uninstall_handlers=None])
rclpy try_shutdown(*, context=None, [uninstall_handlers=None])
rclpy ok(*, context=None)
rclpy get_global_executor()
rclpy get_default_context(*, shutting_down=False)
rclpy create_node({NODE})
rclpy spin(node, executor=None)
rclpy spin_once(node, *, executor=None, timeout_sec=None)
rclpy spin_until_future_complete(node, future, executor=None, timeout_sec=None)
rclpy.utilities get_default_context(*, shutting_down=False)
rclpy.utilities ok(*, context=None)
rclpy.utilities shutdown(*, context=None, [uninstall_handlers=None])
rclpy.utilities remove_ros_args(args=None)
rclpy.utilities timeout_sec_to_nsec(timeout_sec)
rclpy.wait_for_message wait_for_message(msg_type, node, topic, *, qos_profile=1, time_to_wait=-1)
rclpy.node Node({NODE})
rclpy.node Node.create_publisher(msg_type, topic, qos_profile, *, callback_group=None, event_callbacks=None, \
qos_overriding_options=None, publisher_class=Publisher)
rclpy.node Node.create_subscription(msg_type, topic, callback, qos_profile, *, callback_group=None, \
event_callbacks=None, qos_overriding_options=None, raw=False)
rclpy.node Node.create_client(srv_type, srv_name, *, qos_profile=services_default, callback_group=None)
rclpy.node Node.create_service(srv_type, srv_name, callback, *, qos_profile=services_default, callback_group=None)
rclpy.node Node.create_timer(timer_period_sec, callback, callback_group=None, clock=None, [autostart=True])
rclpy.node Node.create_rate(frequency, clock=None)
rclpy.node Node.create_guard_condition(callback, callback_group=None)
rclpy.node Node.destroy_publisher(publisher)
rclpy.node Node.destroy_subscription(subscription)
rclpy.node Node.destroy_client(client)
rclpy.node Node.destroy_service(service)
rclpy.node Node.destroy_timer(timer)
rclpy.node Node.destroy_guard_condition(guard)
rclpy.node Node.destroy_rate(rate)
rclpy.node Node.destroy_node()
rclpy.node Node.declare_parameter(name, value=None, descriptor=None, ignore_override=False)
rclpy.node Node.declare_parameters(namespace, parameters, ignore_override=False)
rclpy.node Node.undeclare_parameter(name)
rclpy.node Node.has_parameter(name)
rclpy.node Node.get_parameter(name)
rclpy.node Node.get_parameters(names)
rclpy.node Node.get_parameter_or(name, alternative_value=None)
rclpy.node Node.get_parameters_by_prefix(prefix)
rclpy.node Node.set_parameters(parameter_list)
rclpy.node Node.set_parameters_atomically(parameter_list)
rclpy.node Node.describe_parameter(name)
rclpy.node Node.describe_parameters(names)
rclpy.node Node.set_descriptor(name, descriptor, alternative_value=None)
rclpy.node Node.list_parameters(prefixes, depth)
rclpy.node Node.add_on_set_parameters_callback(callback)
rclpy.node Node.remove_on_set_parameters_callback(callback)
rclpy.node Node.add_pre_set_parameters_callback(callback)
rclpy.node Node.add_post_set_parameters_callback(callback)
rclpy.node Node.remove_pre_set_parameters_callback(callback)
rclpy.node Node.remove_post_set_parameters_callback(callback)
rclpy.node Node.get_name()
rclpy.node Node.get_namespace()
rclpy.node Node.get_fully_qualified_name()
rclpy.node Node.get_clock()
rclpy.node Node.get_logger()
rclpy.node Node.get_node_names()
rclpy.node Node.get_node_names_and_namespaces()
rclpy.node Node.get_node_names_and_namespaces_with_enclaves()
rclpy.node Node.get_fully_qualified_node_names()
rclpy.node Node.get_topic_names_and_types(no_demangle=False)
rclpy.node Node.get_service_names_and_types()
rclpy.node Node.get_publisher_names_and_types_by_node(node_name, node_namespace, no_demangle=False)
rclpy.node Node.get_subscriber_names_and_types_by_node(node_name, node_namespace, no_demangle=False)
rclpy.node Node.get_service_names_and_types_by_node(node_name, node_namespace)
rclpy.node Node.get_client_names_and_types_by_node(node_name, node_namespace)
rclpy.node Node.count_publishers(topic_name)
rclpy.node Node.count_subscribers(topic_name)
rclpy.node Node.get_publishers_info_by_topic(topic_name, no_mangle=False)
rclpy.node Node.get_subscriptions_info_by_topic(topic_name, no_mangle=False)
rclpy.node Node.resolve_topic_name(topic, *, only_expand=False)
rclpy.node Node.resolve_service_name(service, *, only_expand=False)
rclpy.publisher Publisher.publish(msg)
rclpy.publisher Publisher.get_subscription_count()
rclpy.publisher Publisher.wait_for_all_acked(timeout=forever)
rclpy.publisher Publisher.destroy()
rclpy.subscription Subscription.destroy()
rclpy.client Client.call(request, [timeout_sec=None])
rclpy.client Client.call_async(request)
rclpy.client Client.service_is_ready()
rclpy.client Client.wait_for_service(timeout_sec=None)
rclpy.client Client.remove_pending_request(future)
rclpy.client Client.destroy()
rclpy.service Service.destroy()
rclpy.service Service.configure_introspection(clock, service_event_qos_profile, introspection_state)
rclpy.client Client.configure_introspection(clock, service_event_qos_profile, introspection_state)
rclpy.action ActionServer(node, action_type, action_name, execute_callback, *, callback_group=None, \
goal_callback=default_goal_callback, handle_accepted_callback=default_handle_accepted_callback, \
cancel_callback=default_cancel_callback, goal_service_qos_profile=services_default, \
result_service_qos_profile=services_default, cancel_service_qos_profile=services_default, \
feedback_pub_qos_profile=depth_10, status_pub_qos_profile=action_status_default, result_timeout=10)
rclpy.action ActionServer.register_handle_accepted_callback(handle_accepted_callback)
rclpy.action ActionServer.register_goal_callback(goal_callback)
rclpy.action ActionServer.register_cancel_callback(cancel_callback)
rclpy.action ActionServer.register_execute_callback(execute_callback)
rclpy.action ActionServer.notify_execute(goal_handle, execute_callback)
rclpy.action ActionServer.configure_introspection(clock, service_event_qos_profile, introspection_state)
rclpy.action ActionServer.destroy()
rclpy.action.server ServerGoalHandle(action_server, goal_info, goal_request)
rclpy.action.server ServerGoalHandle.execute(execute_callback=None)
rclpy.action.server ServerGoalHandle.publish_feedback(feedback)
rclpy.action.server ServerGoalHandle.succeed([response=None])
rclpy.action.server ServerGoalHandle.abort([response=None])
rclpy.action.server ServerGoalHandle.canceled([response=None])
rclpy.action.server ServerGoalHandle.destroy()
rclpy.action ActionClient(node, action_type, action_name, *, callback_group=None, \
goal_service_qos_profile=services_default, result_service_qos_profile=services_default, \
cancel_service_qos_profile=services_default, feedback_sub_qos_profile=depth_10, \
status_sub_qos_profile=action_status_default)
rclpy.action ActionClient.send_goal(goal, **kwargs)
rclpy.action ActionClient.send_goal_async(goal, feedback_callback=None, goal_uuid=None)
rclpy.action ActionClient.server_is_ready()
rclpy.action ActionClient.wait_for_server(timeout_sec=None)
rclpy.action ActionClient.configure_introspection(clock, service_event_qos_profile, introspection_state)
rclpy.action ActionClient.destroy()
rclpy.action.client ClientGoalHandle.cancel_goal()
rclpy.action.client ClientGoalHandle.cancel_goal_async()
rclpy.action.client ClientGoalHandle.get_result()
rclpy.action.client ClientGoalHandle.get_result_async()
rclpy.action get_action_names_and_types(node)
rclpy.action get_action_server_names_and_types_by_node(node, remote_node_name, remote_node_namespace)
rclpy.action get_action_client_names_and_types_by_node(node, remote_node_name, remote_node_namespace)
rclpy.lifecycle LifecycleNode(node_name, *, enable_communication_interface=True, **kwargs)
rclpy.lifecycle LifecycleNode.on_configure(state)
rclpy.lifecycle LifecycleNode.on_error(state)
rclpy.lifecycle LifecycleNode.trigger_configure()
rclpy.lifecycle LifecycleNode.trigger_shutdown()
rclpy.lifecycle LifecycleNode.add_managed_entity(entity)
rclpy.lifecycle LifecycleNode.create_lifecycle_publisher(*args, **kwargs)
rclpy.lifecycle LifecycleNode.destroy_lifecycle_publisher(publisher)
rclpy.executors Executor.wait_for_ready_callbacks([timeout_sec=None], [nodes=None], [condition=<lambda>])
rclpy.task Future(*, executor=None)
rclpy.task Future.done()
rclpy.task Future.result()
rclpy.task Future.exception()
rclpy.task Future.cancel()
rclpy.task Future.cancelled()
rclpy.task Future.set_result(result)
rclpy.task Future.set_exception(exception)
rclpy.task Future.add_done_callback(callback)
rclpy.task Task(handler, args=None, kwargs=None, executor=None)
rclpy.timer Timer.cancel()
rclpy.timer Timer.reset()
rclpy.timer Timer.is_canceled()
rclpy.timer Timer.is_ready()
rclpy.timer Timer.time_since_last_call()
rclpy.timer Timer.time_until_next_call()
rclpy.timer Timer.destroy()
rclpy.timer Rate.sleep()
rclpy.timer Rate.destroy()
rclpy.clock Clock(*, clock_type=SYSTEM_TIME)
rclpy.clock Clock.now()
rclpy.clock Clock.create_jump_callback(threshold, *, pre_callback=None, post_callback=None)
rclpy.clock JumpThreshold(*, min_forward, min_backward, on_clock_change=True)
rclpy.node Node.wait_for_node(fully_qualified_node_name, timeout)
rclpy.node Node.add_waitable(waitable)
rclpy.node Node.remove_waitable(waitable)
rclpy.waitable Waitable(callback_group)
rclpy.guard_condition GuardCondition(callback, callback_group, context=None)
rclpy.clock Clock.sleep_until(until, context=None)
rclpy.clock Clock.sleep_for(rel_time, context=None)
rclpy.time Time(*, seconds=0, nanoseconds=0, clock_type=SYSTEM_TIME)
rclpy.time Time.seconds_nanoseconds()
rclpy.time Time.to_msg()
rclpy.time Time.from_msg(msg, clock_type=ROS_TIME)
rclpy.duration Duration(*, seconds=0, nanoseconds=0)
rclpy.duration Duration.to_msg()
rclpy.duration Duration.from_msg(msg)
rclpy.parameter Parameter(name, type_=None, value=None)
rclpy.parameter Parameter.get_parameter_value()
rclpy.parameter Parameter.to_parameter_msg()
rclpy.parameter Parameter.from_parameter_msg(param_msg)
rclpy.executors Executor(*, context=None)
rclpy.executors SingleThreadedExecutor(*, context=None)
rclpy.executors MultiThreadedExecutor(num_threads=None, *, context=None)
rclpy.executors Executor.add_node(node)
rclpy.executors Executor.remove_node(node)
rclpy.executors Executor.get_nodes()
rclpy.executors Executor.spin()
rclpy.executors Executor.spin_once(timeout_sec=None)
rclpy.executors Executor.spin_until_future_complete(future, timeout_sec=None)
rclpy.executors Executor.spin_once_until_future_complete(future, timeout_sec=None)
rclpy.executors Executor.create_task(callback, *args, **kwargs)
rclpy.executors Executor.shutdown(timeout_sec=None)
rclpy.executors Executor.wake()
rclpy.callback_groups MutuallyExclusiveCallbackGroup()
rclpy.callback_groups ReentrantCallbackGroup()
rclpy.callback_groups CallbackGroup.add_entity(entity)
rclpy.callback_groups CallbackGroup.has_entity(entity)
rclpy.callback_groups CallbackGroup.can_execute(entity)
rclpy.context Context.init(args=None, *, initialize_logging=True, domain_id=None)
rclpy.context Context.ok()
rclpy.context Context.shutdown()
rclpy.context Context.try_shutdown()
rclpy.context Context.on_shutdown(callback)
rclpy.context Context.get_domain_id()
rclpy.guard_condition GuardCondition.trigger()
rclpy.impl.rcutils_logger RcutilsLogger.debug(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.info(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.warning(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.warn(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.error(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.fatal(message, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.log(message, severity, **kwargs)
rclpy.impl.rcutils_logger RcutilsLogger.set_level(level)
rclpy.impl.rcutils_logger RcutilsLogger.get_effective_level()
rclpy.impl.rcutils_logger RcutilsLogger.is_enabled_for(severity)
rclpy.impl.rcutils_logger RcutilsLogger.get_child(name)
rclpy.logging get_logger(name)
rclpy.logging set_logger_level(name, level, [detailed_error=False])
rclpy.logging get_logger_effective_level(name)
rclpy.logging get_logging_severity_from_string(log_severity)
rclpy.logging get_logging_directory()
rclpy.logging initialize()
rclpy.logging shutdown()
rclpy.logging clear_config()
rclpy.logging get_logger_level(name)
rclpy.utilities get_rmw_implementation_identifier()
rclpy.utilities get_available_rmw_implementations()
rclpy.utilities try_shutdown(*, context=None, [uninstall_handlers=None])
rclpy.serialization serialize_message(message)
rclpy.serialization deserialize_message(serialized_message, message_type)
rclpy.parameter parameter_value_to_python(parameter_value)
rclpy.parameter parameter_dict_from_yaml_file(parameter_file, use_wildcard=False, target_nodes=None, namespace='')
rclpy.parameter_client AsyncParameterClient(node, remote_node_name, *, qos_profile=services_default, \
callback_group=None)
rclpy.parameter_client AsyncParameterClient.services_are_ready()
rclpy.parameter_client AsyncParameterClient.wait_for_services(timeout_sec=None)
rclpy.parameter_client AsyncParameterClient.list_parameters(prefixes=None, depth=None, callback=None)
rclpy.parameter_client AsyncParameterClient.get_parameters(names, callback=None)
rclpy.parameter_client AsyncParameterClient.set_parameters(parameters, callback=None)
rclpy.parameter_client AsyncParameterClient.set_parameters_atomically(parameters, callback=None)
rclpy.parameter_client AsyncParameterClient.describe_parameters(names, callback=None)
rclpy.parameter_client AsyncParameterClient.get_parameter_types(names, callback=None)
rclpy.parameter_client AsyncParameterClient.delete_parameters(names, callback=None)
rclpy.parameter_client AsyncParameterClient.load_parameter_file(parameter_file, use_wildcard=False, callback=None)
rclpy.parameter_client AsyncParameterClient.load_parameter_file_atomically(parameter_file, use_wildcard=False, \
callback=None)
rclpy.qos_overriding_options QoSOverridingOptions(policy_kinds, *, callback=None, entity_id=None)
rclpy.qos_overriding_options QoSOverridingOptions.with_default_policies(*, callback=None, entity_id=None)
rclpy.event_handler PublisherEventCallbacks(*, deadline=None, liveliness=None, incompatible_qos=None, \
incompatible_type=None, matched=None, use_default_callbacks=True)
rclpy.event_handler SubscriptionEventCallbacks(*, deadline=None, liveliness=None, message_lost=None, \
incompatible_qos=None, incompatible_type=None, matched=None, use_default_callbacks=True)
rclpy.qos QoSProfile(**kwargs)
rclpy.qos qos_check_compatible(publisher_qos, subscription_qos)
rclpy.expand_topic_name expand_topic_name(topic_name, node_name, node_namespace)
rclpy.validate_node_name validate_node_name(node_name)
rclpy.validate_namespace validate_namespace(namespace)
rclpy.validate_topic_name validate_topic_name(name, *, is_service=False)
rclpy.validate_full_topic_name validate_full_topic_name(name, *, is_service=False)
rclpy.topic_or_service_is_hidden topic_or_service_is_hidden(name)
tf2_ros Buffer(cache_time=None, node=None)
tf2_ros Buffer.lookup_transform(target_frame, source_frame, time=0, timeout=0)
tf2_ros Buffer.can_transform(target_frame, source_frame, time=0, timeout=0, return_debug_tuple=False)
tf2_ros Buffer.transform(object_stamped, target_frame, timeout=0, new_type=None)
tf2_ros Buffer.transform_full(object_stamped, target_frame, target_time, fixed_frame, timeout=0, new_type=None)
tf2_ros Buffer.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout=0)
tf2_ros Buffer.can_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout=0, \
return_debug_tuple=False)
tf2_ros Buffer.lookup_transform_async(target_frame, source_frame, time)
tf2_ros Buffer.wait_for_transform_async(target_frame, source_frame, time)
tf2_ros TransformRegistration.add(key, callback)
tf2_ros TransformRegistration.get(key)
tf2_ros convert(a, b_type)
tf2_geometry_msgs do_transform_point(point, transform)
tf2_geometry_msgs do_transform_vector3(vector3, transform)
tf2_geometry_msgs do_transform_pose(pose, transform)
tf2_geometry_msgs do_transform_pose_stamped(pose, transform)
tf2_geometry_msgs do_transform_pose_with_covariance_stamped(pose, transform)
sensor_msgs_py.point_cloud2 read_points(cloud, field_names=None, skip_nans=False, uvs=None, \
reshape_organized_cloud=False)
sensor_msgs_py.point_cloud2 read_points_numpy(cloud, field_names=None, skip_nans=False, uvs=None, \
reshape_organized_cloud=False)
sensor_msgs_py.point_cloud2 read_points_list(cloud, field_names=None, skip_nans=False, uvs=None)
sensor_msgs_py.point_cloud2 dtype_from_fields(fields, point_step=None)
sensor_msgs_py.point_cloud2 create_cloud(header, fields, points, [step=None])
sensor_msgs_py.point_cloud2 create_cloud_xyz32(header, points, [step=None])
tf2_ros TransformListener(buffer, node, *, spin_thread=False, qos=None, static_qos=None)
tf2_ros TransformBroadcaster.sendTransform(transform)
tf2_ros StaticTransformBroadcaster.sendTransform(transform)
tf_transformations euler_from_quaternion(quaternion, axes='sxyz')
tf_transformations quaternion_from_euler(ai, aj, ak, axes='sxyz')
"""

PROPERTIES = """
rclpy.node Node: publishers subscriptions clients services timers guards executor context default_callback_group handle
rclpy.publisher Publisher: topic_name
rclpy.action ActionServer: action_type
rclpy.action.server ServerGoalHandle: request goal_id is_active is_cancel_requested status
rclpy.action.client ClientGoalHandle: goal_id stamp accepted status
rclpy.lifecycle LifecyclePublisher: is_activated
rclpy.subscription Subscription: topic_name
rclpy.timer Timer: timer_period_ns clock
rclpy.time Time: nanoseconds clock_type
rclpy.duration Duration: nanoseconds
rclpy.parameter Parameter: name type_ value
rclpy.clock Clock: clock_type
rclpy.executors Executor: context
"""

ROWS = [line for line in TABLE.strip().splitlines() if line]


def spelled(parameter: inspect.Parameter) -> str:
    """A parameter as the table writes it."""
    star = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}.get(
        parameter.kind, ""
    )
    if parameter.default is inspect.Parameter.empty:
        return star + parameter.name
    return f"{parameter.name}={shown(parameter.default)}"


def shown(default: Any) -> str:
    from rclpy.duration import Duration
    from rclpy.qos import (
        QoSProfile,
        qos_profile_action_status_default,
        qos_profile_services_default,
    )
    from rclpy.time import Time

    if default is qos_profile_services_default:
        return "services_default"
    if default is qos_profile_action_status_default:
        return "action_status_default"
    if isinstance(default, QoSProfile):
        return f"depth_{default.depth}"
    if isinstance(default, (Duration, Time)):
        return "0" if default.nanoseconds == 0 else "forever"
    return str(getattr(default, "name", getattr(default, "__name__", repr(default))))


@every_case("row", ROWS, ids=lambda row: row.partition("(")[0].replace(" ", "."))
def test_a_callable_has_its_parameters(row: str) -> None:
    module, _, rest = row.partition(" ")
    name, _, listed = rest.partition("(")
    found: Any = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found, part)
    parameters = list(inspect.signature(found).parameters.values())
    if "." in name and parameters and parameters[0].name == "self":
        parameters = parameters[1:]
    ours: list[str] = []
    for parameter in parameters:
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY and "*" not in ours and "*args" not in ours:
            ours.append("*")
        ours.append(spelled(parameter))
    wanted = [part.strip("[] ") for part in listed.rstrip(")").split(",") if part]
    assert ours == wanted


@pytest.mark.parametrize("row", PROPERTIES.strip().splitlines(), ids=lambda row: row.partition(":")[0])
def test_a_class_has_its_properties(row: str) -> None:
    place, _, names = row.partition(":")
    module, _, cls = place.partition(" ")
    owner = getattr(importlib.import_module(module), cls)
    annotated = {name for base in owner.__mro__ for name in getattr(base, "__annotations__", {})}
    source = inspect.getsource(owner)
    for name in names.split():
        assert hasattr(owner, name) or name in annotated or f"self.{name} = " in source, name


@pytest.mark.parametrize(
    ("enum", "values"),
    [
        ("HistoryPolicy", {"SYSTEM_DEFAULT": 0, "KEEP_LAST": 1, "KEEP_ALL": 2, "UNKNOWN": 3}),
        ("ReliabilityPolicy", {"SYSTEM_DEFAULT": 0, "RELIABLE": 1, "BEST_EFFORT": 2}),
        ("DurabilityPolicy", {"SYSTEM_DEFAULT": 0, "TRANSIENT_LOCAL": 1, "VOLATILE": 2}),
    ],
)
def test_policies_have_their_numbers_and_their_old_names(enum: str, values: dict[str, int]) -> None:
    qos = importlib.import_module("rclpy.qos")
    assert {name: getattr(qos, enum)[name].value for name in values} == values
    assert getattr(qos, f"QoS{enum}") is getattr(qos, enum)


@every_case(
    ("profile", "preset", "depth", "reliability"),
    [
        ("qos_profile_sensor_data", "SENSOR_DATA", 5, "BEST_EFFORT"),
        ("qos_profile_services_default", "SERVICES_DEFAULT", 10, "RELIABLE"),
        ("qos_profile_default", "DEFAULT", 10, "RELIABLE"),
        ("qos_profile_parameters", "PARAMETERS", 1000, "RELIABLE"),
        ("qos_profile_parameter_events", "PARAMETER_EVENTS", 1000, "RELIABLE"),
    ],
)
def test_presets_are_as_in_ros(profile: str, preset: str, depth: int, reliability: str) -> None:
    qos = importlib.import_module("rclpy.qos")
    found = getattr(qos, profile)
    assert (found.depth, found.reliability.name) == (depth, reliability)
    assert (found.history.name, found.durability.name) == ("KEEP_LAST", "VOLATILE")
    assert qos.QoSPresetProfiles[preset].value == found
    assert qos.QoSPresetProfiles.get_from_short_key(preset.lower()) == found


def test_parameter_types_have_their_numbers() -> None:
    kinds = importlib.import_module("rclpy.parameter").Parameter.Type
    assert [kind.name for kind in sorted(kinds, key=lambda kind: kind.value)] == (
        [
            "NOT_SET",
            "BOOL",
            "INTEGER",
            "DOUBLE",
            "STRING",
            "BYTE_ARRAY",
            "BOOL_ARRAY",
            "INTEGER_ARRAY",
            "DOUBLE_ARRAY",
            "STRING_ARRAY",
        ]
    )
