"""What goes wrong, as exceptions."""


class FileError(ValueError):
    """The bytes are no file that this version reads.

    `rule` is the number of the rule of format/SPEC.md that is broken (0: none), `offset` the byte where it shows, `code`
    that of `AcdfErrorCode`: 4 a limit is exceeded, 5 malformed, 6 unsupported.
    """

    def __init__(self, message: str, code: int = 0, rule: int = 0, offset: int = 0):
        super().__init__(message)
        self.code = code
        self.rule = rule
        self.offset = offset


class BuildError(ValueError):
    """No file can be built so. `code` is that of `acdf::builder::ErrorCode`: 2 bad source, 3 no energy, 4 out of reach,
    5 cancelled, 7 a callback failed."""

    def __init__(self, message: str, code: int = 0):
        super().__init__(message)
        self.code = code
