from kit.msg.type_description_interfaces import Field as Field
from kit.msg.type_description_interfaces import FieldType as FieldType
from kit.msg.type_description_interfaces import IndividualTypeDescription as IndividualTypeDescription
from kit.msg.type_description_interfaces import KeyValue as KeyValue
from kit.msg.type_description_interfaces import TypeDescription as TypeDescription
from kit.msg.type_description_interfaces import TypeSource as TypeSource
