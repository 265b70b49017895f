from array import array as _array
from typing import ClassVar as _ClassVar

import numpy as _np
from numpy.typing import NDArray as _NDArray

from kit.msg.message import Action as _Action
from kit.msg.message import Message as _Message
from kit.msg.message import Service as _Service

class Field(_Message):
    name: str = ...
    type: FieldType = ...
    default_value: str = ...
class FieldType(_Message):
    FIELD_TYPE_NOT_SET: _ClassVar[int]
    FIELD_TYPE_NESTED_TYPE: _ClassVar[int]
    FIELD_TYPE_INT8: _ClassVar[int]
    FIELD_TYPE_UINT8: _ClassVar[int]
    FIELD_TYPE_INT16: _ClassVar[int]
    FIELD_TYPE_UINT16: _ClassVar[int]
    FIELD_TYPE_INT32: _ClassVar[int]
    FIELD_TYPE_UINT32: _ClassVar[int]
    FIELD_TYPE_INT64: _ClassVar[int]
    FIELD_TYPE_UINT64: _ClassVar[int]
    FIELD_TYPE_FLOAT: _ClassVar[int]
    FIELD_TYPE_DOUBLE: _ClassVar[int]
    FIELD_TYPE_LONG_DOUBLE: _ClassVar[int]
    FIELD_TYPE_CHAR: _ClassVar[int]
    FIELD_TYPE_WCHAR: _ClassVar[int]
    FIELD_TYPE_BOOLEAN: _ClassVar[int]
    FIELD_TYPE_BYTE: _ClassVar[int]
    FIELD_TYPE_STRING: _ClassVar[int]
    FIELD_TYPE_WSTRING: _ClassVar[int]
    FIELD_TYPE_FIXED_STRING: _ClassVar[int]
    FIELD_TYPE_FIXED_WSTRING: _ClassVar[int]
    FIELD_TYPE_BOUNDED_STRING: _ClassVar[int]
    FIELD_TYPE_BOUNDED_WSTRING: _ClassVar[int]
    FIELD_TYPE_NESTED_TYPE_ARRAY: _ClassVar[int]
    FIELD_TYPE_INT8_ARRAY: _ClassVar[int]
    FIELD_TYPE_UINT8_ARRAY: _ClassVar[int]
    FIELD_TYPE_INT16_ARRAY: _ClassVar[int]
    FIELD_TYPE_UINT16_ARRAY: _ClassVar[int]
    FIELD_TYPE_INT32_ARRAY: _ClassVar[int]
    FIELD_TYPE_UINT32_ARRAY: _ClassVar[int]
    FIELD_TYPE_INT64_ARRAY: _ClassVar[int]
    FIELD_TYPE_UINT64_ARRAY: _ClassVar[int]
    FIELD_TYPE_FLOAT_ARRAY: _ClassVar[int]
    FIELD_TYPE_DOUBLE_ARRAY: _ClassVar[int]
    FIELD_TYPE_LONG_DOUBLE_ARRAY: _ClassVar[int]
    FIELD_TYPE_CHAR_ARRAY: _ClassVar[int]
    FIELD_TYPE_WCHAR_ARRAY: _ClassVar[int]
    FIELD_TYPE_BOOLEAN_ARRAY: _ClassVar[int]
    FIELD_TYPE_BYTE_ARRAY: _ClassVar[int]
    FIELD_TYPE_STRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_WSTRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_FIXED_STRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_FIXED_WSTRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_BOUNDED_STRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: _ClassVar[int]
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: _ClassVar[int]
    type_id: int = ...
    capacity: int = ...
    string_capacity: int = ...
    nested_type_name: str = ...
class IndividualTypeDescription(_Message):
    type_name: str = ...
    fields: list[Field] = ...
class KeyValue(_Message):
    key: str = ...
    value: str = ...
class TypeDescription(_Message):
    type_description: IndividualTypeDescription = ...
    referenced_type_descriptions: list[IndividualTypeDescription] = ...
class TypeSource(_Message):
    type_name: str = ...
    encoding: str = ...
    raw_file_contents: str = ...
class GetTypeDescription(_Service):
    class Request(_Message):
        type_name: str = ...
        type_hash: str = ...
        include_type_sources: bool = ...
    class Response(_Message):
        successful: bool = ...
        failure_reason: str = ...
        type_description: TypeDescription = ...
        type_sources: list[TypeSource] = ...
        extra_information: list[KeyValue] = ...
