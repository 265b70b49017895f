from kit.msg.unique_identifier_msgs import UUID as UUID
