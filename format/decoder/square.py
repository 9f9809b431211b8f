"""SPEC.md §6.6: the equal-area octahedral square."""
import math

from .sphere import BETA, PI, Sphere, a, clamp, f32, pdf32, sin_cos
from .tree import fraction_sampled, slope


class Square:
    """The grid of §6.6: W columns, H rows. What Sphere is to parameterization 1."""

    def __init__(self, columns, rows):
        self.W, self.H = columns, rows

    def whole(self):
        return [[0, self.W], [0, self.H]], [0.0, 0.0]

    def place(self, box, u, s, p):
        t = [fraction_sampled(u[0], s[0]), fraction_sampled(u[1], s[1])]
        at = []
        for k, resolution in enumerate((self.W, self.H)):
            low, high = box[k]
            border = BETA * resolution / 2
            at.append(clamp(low + t[k] * (high - low), low + border, high - border) / resolution)
        return (*map(f32, direction_of_square(*at)), self.density(box, s, t, p))

    def density(self, box, s, t, p):
        if not p > 0:
            return 0.0
        (x0, x1), (y0, y1) = box
        shape = slope(s[0], t[0]) * slope(s[1], t[1])
        return pdf32(p * self.W * self.H / (4 * PI * (x1 - x0) * (y1 - y0)) * shape)

    def grid(self, v):
        """Positions on both axes, and the square."""
        u = square_of_direction(v)
        at = u[0] * self.W, u[1] * self.H
        return at, [min(math.floor(at[0]), self.W - 1), min(math.floor(at[1]), self.H - 1)]

    def fractions(self, _, at, box):
        return [clamp((x - low) / (high - low), 0, 1) for x, (low, high) in zip(at, box)]


def grid_of(d):
    """The grid of directions that DESC asks for."""
    return (Square if d.parameterization == 4 else Sphere)(d.axes[0].resolution, d.axes[1].resolution)


def direction_of_square(u, v):
    left, right = abs(2 * u - 1), abs(2 * v - 1)
    e = left + right - 1
    r = 1 - abs(e)
    sine, cosine = sin_cos(((right - left) / r + 1) / 4 if r > 0 else 0.0)
    rho = r * math.sqrt(2 - r * r)
    return (-rho * cosine if u > 0.5 else rho * cosine), (-rho * sine if v < 0.5 else rho * sine), -e * (1 + r)


def square_of_direction(d):
    x, y, z = d
    length = math.sqrt(x * x + y * y + z * z)
    r = math.sqrt((x * x + y * y) / (length * (length + abs(z))))
    b = 2 * r * a(abs(y), abs(x))
    left, right = r - b, b
    if z < 0:
        left, right = 1 - right, 1 - left
    return (1 - left) / 2 if x > 0 else (1 + left) / 2, (1 - right) / 2 if y < 0 else (1 + right) / 2
