"""The command `impact-damper`, and the YAML files that describe machines."""
