"""What sensors measure of a person: sensor kinds, innovations, fields of view."""
