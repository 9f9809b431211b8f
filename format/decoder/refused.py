"""What a reader does with a file that breaks a rule (SPEC.md §1)."""


class Refused(Exception):
    """A file is refused; `rule` is the number of a rule that it breaks."""

    def __init__(self, rule, detail=""):
        super().__init__(f"rule {rule}: {detail}")
        self.rule = rule


def require(condition, rule, detail=""):
    if not condition:
        raise Refused(rule, detail)
