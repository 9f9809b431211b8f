"""A reader of .acdf files that was written from the text of SPEC.md alone, step by step, in Python and NumPy.

It is there to test that text, and as a model for readers in other languages: slow and short, with the numbers of
sections and steps beside the code. It shares nothing with lib/reader.

    from decoder import load
    sky = load(open("probe.acdf", "rb").read())
    x, y, z, pdf = sky.sample(0.25, 0.5)          # pdf in sr^-1
    pdf = sky.pdf((x, y, z))
    u0, u1 = sky.invert((x, y, z))                # of environments
"""
from .container import Refused, read_container
from .description import read_description
from .kinds import view_of


def load(data):
    """The view of a file's bytes: Environment, Local, Brdf, Table or Indexed. Raises Refused, with the number of a rule."""
    container = read_container(data)
    description = read_description(container)
    return view_of(container, description)


__all__ = ["Refused", "load"]
