"""What can go wrong, and what to do about it.

    TrackerError
        ConfigError        a parameter file or value (also a ValueError)
        ShapeError         arrays that disagree in shape (also a ValueError)
        MeasurementError   a measurement that no tracker can use (also a ValueError)
        ClockError         stamps that no tracker can live with (also a ValueError)
        TransformError     no transform between two frames at a stamp (also a LookupError)
        ModelFileError     a model file that is missing, broken or cannot be fetched
        RecordingError     a recording, video or folder that cannot be read or written
          OutputError      a file that cannot be written
        SceneError         a simulation scene that makes no sense (also a ValueError)
        WorkerError        processes or a cluster that die or cannot be reached
        CalibrationError   data that do not determine what was asked for (also a ValueError)

Every message says what came, what was needed and what to do. The command line prints the message
alone and leaves with status 1, or 2 where the user's own words (file names, parameters) are off.
"""


class TrackerError(Exception):
    """Any failure that this project foresees; its message is fit for a user's eyes."""


class ConfigError(TrackerError, ValueError):
    """A parameter is unknown, of the wrong type or out of range."""


class ShapeError(TrackerError, ValueError):
    """Arrays that belong together disagree in shape."""


class MeasurementError(TrackerError, ValueError):
    """A measurement holds numbers that no tracker can use."""


class ClockError(TrackerError, ValueError):
    """A stamp is negative, not finite or otherwise unusable."""


class TransformError(TrackerError, LookupError):
    """Two frames are not connected at the stamp that was asked for."""


class ModelFileError(TrackerError):
    """A model file is missing, broken, or could not be fetched or written."""


class RecordingError(TrackerError):
    """A recording cannot be read, or an output cannot be written."""


class OutputError(RecordingError):
    """An output cannot be written."""


class SceneError(TrackerError, ValueError):
    """A simulation scene contradicts itself or asks for the impossible."""


class WorkerError(TrackerError):
    """The processes or the cluster that do the work died, or cannot be reached."""


class CalibrationError(TrackerError, ValueError):
    """The data do not determine what should be found from them."""
