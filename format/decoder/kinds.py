"""SPEC.md §2.1: from the chunks of a file to the view of its kind."""
from .brdf import Brdf
from .partner import Partner
from .container import BRDF, ENVIRONMENT, INDEXED, LOCAL, TABLE
from .description import NOT_STORED
from .halvings import Halvings
from .indexed import Indexed, check_indexed_axes
from .local import Local
from .normals import NormalRows
from .refused import require
from .sphere import Environment
from .square import grid_of
from .table import Table
from .tree import Tree, check_tree


def view_of(container, d):
    view = sampler_of(container, d)
    partner = container.payloads.get(b"COMP")
    view.partner = None if partner is None else Partner(partner, container.kind, d.bin_count)
    return view


def sampler_of(container, d):
    chunks, kind = container.payloads, container.kind
    if b"HALV" in chunks:
        require(b"TREE" not in chunks and d.fit == 4, 6035)
        require(b"BINS" not in chunks or kind in (LOCAL, BRDF, TABLE), 6035)
        if kind == TABLE:
            return Table(chunks[b"HALV"], d.axes, d.bins)
        if kind == INDEXED:
            check_indexed_axes(d)
            return Indexed(chunks[b"HALV"], chunks[b"MAPS"], d)
        if kind in (LOCAL, BRDF):
            require(kind == BRDF or len(d.axes) == 3, 7003)
            tree = Halvings(chunks[b"HALV"], [axis.resolution for axis in d.axes if axis.role == 0])
            rows = NormalRows(tree, chunks[b"NORM"], d.bin_count)
            require(all(root < rows.row_count or root == NOT_STORED for root, _ in d.bins), 6026)
            return local_of(chunks, tree, d, rows) if kind == LOCAL else Brdf(tree, d, rows, chunks.get(b"VIEW"))
        return Environment(Halvings(chunks[b"HALV"], [axis.resolution for axis in d.axes]), None, grid_of(d))
    tree = Tree(chunks[b"TREE"])
    check_tree(tree, d.axes, roots_of(kind, d, tree))
    if kind == ENVIRONMENT:
        return Environment(tree, d.bins[0][0], grid_of(d))
    return local_of(chunks, tree, d, None) if kind == LOCAL else Brdf(tree, d, None, chunks.get(b"VIEW"))


def local_of(chunks, tree, d, rows):
    return Local(tree, d, rows, chunks.get(b"LOCL"), chunks.get(b"PLAC"), chunks.get(b"PORT"))


def roots_of(kind, d, tree):
    """§7.2: where paths begin, each with the box by axis that is inherited there."""
    whole = [[0, axis.resolution] for axis in d.axes]
    roots = [(0, whole)] if kind == LOCAL else []
    for root, _ in d.bins:
        if root == NOT_STORED and kind in (LOCAL, BRDF):
            continue
        require(root in tree.curves, 6010)
        roots.append((root, whole))
    return roots
