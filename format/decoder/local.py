"""SPEC.md §10: local environments."""
import math
import struct

from .description import NOT_STORED, PI, check_sphere_axes, is_axis
from .refused import require
from .sphere import (NOTHING, Environment, Sphere, clamp, direction_of, f32, of_unit_length, random_number,
                     sin_cos)
from .visibility import Visibility
from .portals import Portals
from .square import grid_of


def read_local_chunk(data):
    """§10.1: the cosine's share."""
    require(data is not None and len(data) == 8, 7005)
    sigma, reserved = struct.unpack("<fI", data)
    require(0 <= sigma < 1 and reserved == 0, 7005)
    return sigma


def read_normals(axes, bin_count):
    """The number N of subdivisions, or a grid of normals."""
    require(len(axes) in (3, 4), 7003)
    if len(axes) == 3:
        count = axes[2].resolution
        n = math.isqrt(max(count - 2, 0) // 4)
        require(is_axis(axes[2], b"normal", 1, 0, 0.0, float(count), 4 * 1024**2 + 2), 7003)
        require(n >= 1 and 4 * n * n + 2 == count, 7003)
        grid = None
    else:
        require(is_axis(axes[2], b"normal theta", 1, 0, 0.0, PI, 65536), 7003)
        require(is_axis(axes[3], b"normal phi", 1, 0, PI, -PI, 65536), 7003)
        n, grid, count = 0, Sphere(axes[3].resolution, axes[2].resolution), axes[2].resolution * axes[3].resolution
    require(bin_count == count, 7004)
    return n, grid


def corner_number(n, x, y, z):
    r = n - abs(z)
    before = 4 * n * n + 1 - 2 * r * (r + 1) if z < 0 else 1 + 2 * r * (r - 1) if r > 0 else 0
    if r == 0:
        return before
    if x > 0 and y >= 0:
        return before + y
    if y > 0:
        return before + r - x
    return before + 2 * r - y if x < 0 else before + 3 * r + x


def octahedral_bins(N, n):
    """Pairs of a bin and m, by the five steps."""
    size = abs(n[0]) + abs(n[1]) + abs(n[2])
    at = [abs(x) / size * N for x in n]
    g = [math.floor(x) for x in at]
    f = [x - low for x, low in zip(at, g)]
    r = N - sum(g)
    if r == 3:
        g, r = [low + 1 for low in g], 0
    if r == 0:
        corners = [(g, 1.0)]
    elif r == 1:
        corners = [([low + (k == i) for k, low in enumerate(g)], f[i]) for i in range(3)]
    else:
        corners = [([low + (k != i) for k, low in enumerate(g)], 1 - f[i]) for i in range(3)]
    out = []
    for c, b in corners:
        if b > 0:
            m = b * math.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
            out.append((corner_number(N, *[-x if v < 0 else x for x, v in zip(c, n)]), m))
    return out


class Point:
    """What a normal samples from: `tree` (a root), or `mixture` (pairs of a row and its weight), or nothing."""

    tree = mixture = None
    cell = None  # of its position
    visible_portals = None


class Local:
    def __init__(self, tree, d, rows, chunk, visibility=None, portals=None):
        check_sphere_axes(d)
        self.N, self.grid = read_normals(d.axes, d.bin_count)
        self.sigma = read_local_chunk(chunk)
        self.tree, self.rows, self.bins = tree, rows, d.bins
        self.environment = Environment(tree, 0, grid_of(d))
        self.sphere = self.environment.sphere
        self.visibility = None if visibility is None else Visibility(visibility, rows)
        self.portals = None if portals is None else Portals(portals, self.visibility)

    def point(self, normal, position=None):
        out, n = Point(), direction_of(normal)
        if n is None or n == [0.0, 0.0, 0.0]:
            return out
        out.n = n
        served = octahedral_bins(self.N, n) if self.N else [(self.grid_bin(n), 1.0)]
        if self.rows is None:
            nearest = max(served, key=lambda pair: pair[1])[0]  # the first of equal ones
            root, share = self.bins[nearest]
            out.tree = 0 if root == NOT_STORED else root if share > 0 else None
            return out
        if any(self.bins[b][0] == NOT_STORED for b, _ in served):
            out.tree = 0
            return out
        mixture = [(self.bins[b][0], m * self.bins[b][1]) for b, m in served]
        out.mixture = [(row, w) for row, w in mixture if w > 0] or None
        if position is not None and self.visibility is not None and out.mixture is not None:
            out.cell = self.visibility.cell(position, n)
            if self.portals is not None and out.cell:
                out.visible_portals = self.portals.visible_portals(out.cell, self.visibility.coordinates(position, n))
        return out

    def grid_bin(self, n):
        column, row = self.grid.grid(n)[1]
        return row * self.grid.W + column

    def draw(self, point, u, box, s):
        """Sampling from a mixture."""
        tile, p = (self.visibility.draw(point.mixture, point.cell, u) if point.cell else
                   self.rows.draw(point.mixture, u))
        return self.rows.sample_within(self.tree, tile, p, u, box, s)

    def find(self, point, square, box, s):
        """The cell of a direction."""
        tile, p = (self.visibility.find(point.mixture, point.cell, square) if point.cell else
                   self.rows.find(point.mixture, square))
        return self.rows.find_within(self.tree, tile, p, square, box, s)

    def light_pdf(self, point, v):
        """p_L: of rows, and of visible_portals where the position sees any."""
        row = self.row_pdf(point, v)
        return row if point.visible_portals is None else point.visible_portals.density(v, row)

    def row_pdf(self, point, v):
        """Steps 1 and 2 of the density of a direction."""
        if not of_unit_length(v):
            return 0.0
        box, s = self.sphere.whole()
        column, square = self.sphere.grid(v)
        p = (self.find(point, square, box, s) if point.mixture is not None else
             self.tree.find(point.tree, square, box, s))
        return self.sphere.density(box, s, self.sphere.fractions(v, column, box), p)

    def density(self, point, v, light):
        """Steps 3 and 4."""
        if self.sigma == 0:
            return light
        if not of_unit_length(v):
            return 0.0
        n = point.n
        kappa = (n[0] * v[0] + n[1] * v[1] + n[2] * v[2]) / math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        pdf = (1 - self.sigma) * light + (self.sigma * kappa * (1 / PI) if kappa > 0 else 0.0)
        return f32(max(pdf, 1.17549435e-38)) if pdf != 0 else 0.0

    def sample(self, normal, u0, u1, position=None):
        point, u = self.point(normal, position), [random_number(u0), random_number(u1)]
        if point.tree is None and point.mixture is None:
            return NOTHING
        if u[0] < self.sigma:
            v = self.around(point.n, u[0] / self.sigma, u[1])
            light = self.light_pdf(point, v)
        else:
            if self.sigma > 0:
                u[0] = (u[0] - self.sigma) / (1 - self.sigma)
            *v, light = self.draw_light(point, u)
        return (*v, self.density(point, v, light))

    def draw_light(self, point, u):
        """By rows or through visible_portals: a direction and its p_L."""
        if point.visible_portals is None:
            return self.sample_row(point, u)
        share = point.visible_portals.share
        if u[0] < share:
            v = self.sample_row(point, [clamp(u[0] / share, 0, 1), u[1]])[:3]
        else:
            v = point.visible_portals.draw([clamp((u[0] - share) / (1 - share), 0, 1), u[1]])
        return (*v, self.light_pdf(point, v))

    def sample_row(self, point, u):
        box, s = self.sphere.whole()
        p = (self.draw(point, u, box, s) if point.mixture is not None else
             self.tree.draw(point.tree, u, box, s))
        return self.sphere.place(box, u, s, p)

    @staticmethod
    def around(n, v, u1):
        """Step 2 of a sample."""
        length = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        ex, ey, ez = (x / length for x in n)
        h = math.sqrt(max(1 - u1, 2.0**-40))
        r = math.sqrt(1 - h * h)
        g = -1.0 if ez < 0 else 1.0
        A = -1 / (g + ez)
        B = ex * ey * A
        s, t = (1 + g * ex * ex * A, g * B, -g * ex), (B, g + ey * ey * A, -ey)
        sine, cosine = sin_cos(2 * v - 1)
        return [f32(r * (si * cosine + ti * sine) + h * ei) for si, ti, ei in zip(s, t, (ex, ey, ez))]

    def pdf(self, normal, direction, position=None):
        point, v = self.point(normal, position), direction_of(direction)
        if point.tree is None and point.mixture is None or not of_unit_length(v):
            return 0.0
        return self.density(point, v, self.light_pdf(point, v))
