"""SPEC.md §1, §6.1 to §6.5: numbers, the sphere, and environments."""
import ctypes
import math

from .tree import fraction_sampled, random_number_at, slope

BETA = 2.0**-22
PI = math.pi
NOTHING = (0.0, 0.0, 0.0, 0.0)


def f32(v):
    return ctypes.c_float(v).value  # beyond them all: infinite


def pdf32(v):
    if not v > 1.17549435e-38:
        return f32(1.17549435e-38)
    return f32(3.40282347e+38) if v >= f32(3.40282347e+38) else f32(v)


def clamp(v, low, high):
    return low if v < low else high if v > high else v


def random_number(u):
    return clamp(float(u), 0.0, 1.0) if math.isfinite(u) else 0.0


def a(y, x):
    """atan2(y, x) / pi, -0 taken as 0."""
    return math.atan2(y + 0.0, x + 0.0) / PI


def sin_cos(v):
    """Of pi v, exact at multiples of 1/2."""
    quarter = round(2 * v)
    s, c = math.sin((v - quarter / 2) * PI), math.cos((v - quarter / 2) * PI)
    return [(s, c), (c, -s), (-s, -c), (-c, s)][quarter % 4]


def direction_of(v):
    """Three f32 as f64; None where one is not finite."""
    v = [f32(x) for x in v]
    return v if all(math.isfinite(x) for x in v) else None


class Sphere:
    """The grid of §6.1: W columns, H rows."""

    def __init__(self, columns, rows):
        self.W, self.H = columns, rows

    def z(self, y):
        if 2 * y > self.H:
            return -self.z(self.H - y)
        s = math.sin(PI * y / (2 * self.H))
        return 1 - 2 * s * s

    def whole(self):
        return [[0, self.W], [0, self.H]], [0.0, 0.0]

    def place(self, box, u, s, p):
        """The direction in a cell (§6.3), with its density."""
        (x0, x1), (y0, y1) = box
        t = [fraction_sampled(u[0], s[0]), fraction_sampled(u[1], s[1])]
        x = clamp(x0 + t[0] * (x1 - x0), x0 + self.W * (BETA / (2 * PI)), x1 - self.W * (BETA / (2 * PI)))
        z = self.z(y0) + t[1] * (self.z(y1) - self.z(y0))
        r = math.sqrt((1 - z) * (1 + z))
        z = clamp(z, self.z(y1) + BETA * r, self.z(y0) - BETA * r)
        z = clamp(z, -1 + BETA * BETA / 2, 1 - BETA * BETA / 2)
        r = math.sqrt((1 - z) * (1 + z))
        sine, cosine = sin_cos(1 - 2 * x / self.W)
        return f32(r * cosine), f32(r * sine), f32(z), self.density(box, s, t, p)

    def density(self, box, s, t, p):
        """§6.4."""
        if not p > 0:
            return 0.0
        (x0, x1), (y0, y1) = box
        shape = slope(s[0], t[0]) * slope(s[1], t[1])
        return pdf32(p * self.W / (2 * PI * (x1 - x0) * (self.z(y0) - self.z(y1))) * shape)

    def grid(self, v):
        """Steps 2 to 4 of §6.4: the column, and the square."""
        x, y, z = v
        column = self.W * (0.5 - 0.5 * a(y, x))
        if column >= self.W:
            column = 0.0
        row = self.H * a(math.sqrt(x * x + y * y), z)
        return column, [math.floor(column), min(math.floor(row), self.H - 1)]

    def fractions(self, v, column, box):
        (x0, x1), (y0, y1) = box
        x, y, z = v
        length = math.sqrt(x * x + y * y + z * z)
        cap = (x * x + y * y) / (length * (length + abs(z)))
        zeta = 1 - cap if z >= 0 else cap - 1
        return (clamp((column - x0) / (x1 - x0), 0, 1),
                clamp((self.z(y0) - zeta) / (self.z(y0) - self.z(y1)), 0, 1))


def of_unit_length(v):
    """Step 1 of §6.4."""
    return v is not None and 0.9995 < math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) < 1.0005


class Environment:
    """`tree` is a Tree of curves or Halvings, `sphere` the grid of directions: a Sphere, or the Square of §6.6."""

    def __init__(self, tree, root, sphere):
        self.tree, self.root, self.sphere = tree, root, sphere

    def sample(self, u0, u1):
        return self.sample_light([random_number(u0), random_number(u1)])

    def sample_light(self, u):
        box, s = self.sphere.whole()
        p = self.tree.draw(self.root, u, box, s)
        return self.sphere.place(box, u, s, p)

    def pdf(self, direction):
        v = direction_of(direction)
        if not of_unit_length(v):
            return 0.0
        box, s = self.sphere.whole()
        column, square = self.sphere.grid(v)
        p = self.tree.find(self.root, square, box, s)
        return self.sphere.density(box, s, self.sphere.fractions(v, column, box), p)

    def invert(self, direction):
        """§6.5: the random numbers of a direction; None where its density is 0."""
        v = direction_of(direction)
        if not of_unit_length(v):
            return None
        (box, s), strata = self.sphere.whole(), [[0.0, 1.0], [0.0, 1.0]]
        column, square = self.sphere.grid(v)
        if not self.tree.find(self.root, square, box, s, strata) > 0:
            return None
        t = self.sphere.fractions(v, column, box)
        return [random_number_at(*strata[a], s[a], t[a]) for a in (0, 1)]
