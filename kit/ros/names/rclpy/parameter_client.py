from kit.ros.parameters.parameter_client import AsyncParameterClient

__all__ = ["AsyncParameterClient"]
