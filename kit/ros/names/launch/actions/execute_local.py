"""launch.actions.execute_local of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import (
        EmitEvent as EmitEvent,
        OpaqueFunction as OpaqueFunction,
        Shutdown as Shutdown,
        TimerAction as TimerAction,
    )
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import (
        Action as Action,
        LaunchDescription as LaunchDescription,
        LaunchDescriptionEntity as LaunchDescriptionEntity,
    )
    from kit.ros.launch.event_handlers import (
        EventHandler as EventHandler,
        OnProcessExit as OnProcessExit,
        OnProcessIO as OnProcessIO,
        OnProcessStart as OnProcessStart,
        OnShutdown as OnShutdown,
    )
    from kit.ros.launch.events import (
        Event as Event,
        ProcessExited as ProcessExited,
        ProcessIO as ProcessIO,
        ProcessIO as _ProcessStderr,
        ProcessIO as _ProcessStdin,
        ProcessIO as _ProcessStdout,
        ProcessStarted as ProcessStarted,
        ShutdownProcess as ShutdownProcess,
        SignalProcess as SignalProcess,
        matches_action as matches_action,
    )
    from kit.ros.launch.normalization import (
        SomeEntities as _SomeActionsType,
        SomeEntities as _SomeEntitiesType,
        evaluate_condition_expression as evaluate_condition_expression,
        is_a_subclass as is_a_subclass,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.processes import Executable as Executable, ExecuteLocal as ExecuteLocal
    from kit.ros.launch.substitutions import (
        LaunchConfiguration as LaunchConfiguration,
        PythonExpression as PythonExpression,
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
    )

    ProcessStderr = _ProcessStderr
    ProcessStdin = _ProcessStdin
    ProcessStdout = _ProcessStdout
    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    AsyncSubprocessProtocol: Any
    async_execute_process: Any
    create_future: Any
    normalize_typed_substitution: Any
    perform_typed_substitution: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "AsyncSubprocessProtocol": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "Event": "kit.ros.launch.events:Event",
        "EventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "Executable": "kit.ros.launch.processes:Executable",
        "ExecuteLocal": "kit.ros.launch.processes:ExecuteLocal",
        "LaunchConfiguration": "kit.ros.launch.substitutions:LaunchConfiguration",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "OnProcessIO": "kit.ros.launch.event_handlers:OnProcessIO",
        "OnProcessStart": "kit.ros.launch.event_handlers:OnProcessStart",
        "OnShutdown": "kit.ros.launch.event_handlers:OnShutdown",
        "OpaqueFunction": "kit.ros.launch.actions:OpaqueFunction",
        "ProcessExited": "kit.ros.launch.events:ProcessExited",
        "ProcessIO": "kit.ros.launch.events:ProcessIO",
        "ProcessStarted": "kit.ros.launch.events:ProcessStarted",
        "ProcessStderr": "kit.ros.launch.events:ProcessIO",
        "ProcessStdin": "kit.ros.launch.events:ProcessIO",
        "ProcessStdout": "kit.ros.launch.events:ProcessIO",
        "PythonExpression": "kit.ros.launch.substitutions:PythonExpression",
        "Shutdown": "kit.ros.launch.actions:Shutdown",
        "ShutdownProcess": "kit.ros.launch.events:ShutdownProcess",
        "SignalProcess": "kit.ros.launch.events:SignalProcess",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "TimerAction": "kit.ros.launch.actions:TimerAction",
        "async_execute_process": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "create_future": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "evaluate_condition_expression": "kit.ros.launch.normalization:evaluate_condition_expression",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "matches_action": "kit.ros.launch.events:matches_action",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "normalize_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "perform_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
