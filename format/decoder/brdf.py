"""SPEC.md §11: BRDFs."""
import bisect
import math
import struct

from .description import NOT_STORED, PI, is_axis
from .refused import require
from .sphere import NOTHING, a, clamp, direction_of, f32, pdf32, random_number, sin_cos
from .tree import fraction_sampled, slope


ROWS, AT_POLE, STEPS = 512, 152, 1 << 28


def begin_of_row(i):
    """Where a row of half-vectors begins."""
    t = max(i - AT_POLE, 0) / (ROWS - AT_POLE)
    return STEPS if i == ROWS else max(i, math.floor(2 * math.sin(PI / 4 * t * t) ** 2 * STEPS))


def read_views(chunk, d, halved):
    """Chunk VIEW. Returns mirrored, the diffuse share and the nodes."""
    require(len(d.axes) == 4, 8001)
    low = 0.0 if d.axes[0].low == 0.0 else -PI
    require(is_axis(d.axes[0], b"phi_h", 0, 0, low, PI, 65536), 8001)
    require(is_axis(d.axes[1], b"cos_theta_h", 0, 2 if halved else 0, 1.0, 0.0, ROWS if halved else STEPS), 8001)
    require(not halved or d.axes[1].resolution == ROWS, 8001)
    require(is_axis(d.axes[2], b"theta_o", 1, 0, 0.0, PI / 2, 65536), 8001)
    require(is_axis(d.axes[3], b"phi_o", 1, 0, -PI, PI, 65536), 8001)
    require(d.bin_count == d.axes[2].resolution * d.axes[3].resolution, 8002)
    require(all(root != NOT_STORED for root, _ in d.bins), 8006)
    require(chunk is not None and len(chunk) >= 16, 8003)
    T, F, flags, sigma = struct.unpack_from("<IIIf", chunk)
    require(T == d.axes[2].resolution and F == d.axes[3].resolution, 8003)
    require(len(chunk) == 16 + 4 * T and flags <= 1, 8003)
    require((flags == 1) == (low == 0.0) and (flags == 0 or F == 1), 8003)
    require(0 <= sigma < 1, 8005)
    nodes = struct.unpack_from(f"<{T}f", chunk, 16)
    require(all(0 <= g <= 1 for g in nodes) and all(p < q for p, q in zip(nodes, nodes[1:])), 8004)
    return flags == 1, sigma, nodes


class View:
    """ωo, τ, and `mixture` (empty: no table) or `tree`, a root."""

    mixture = tree = None


class Place:
    """Of a direction of light: ωi, X, Y, ℓ and |ωo · h|."""


class Brdf:
    def __init__(self, tree, d, rows, chunk):
        self.mirrored, self.sigma, self.nodes = read_views(chunk, d, rows is not None)
        self.tree, self.rows_of_views, self.bins, self.total = tree, rows, d.bins, d.total
        self.W, self.H = d.axes[0].resolution, d.axes[1].resolution
        if rows is not None:
            self.H, self.begins = STEPS, [begin_of_row(i) for i in range(ROWS + 1)]
        self.F = d.axes[3].resolution

    def rows(self, wo):
        """Steps 2 and 3: pairs of a bin and its weight."""
        x, y, z = wo
        T, F = len(self.nodes), self.F
        g = math.sqrt(1 - z) if z < 1 else 0.0
        i, t, above = 0, 0.0, 0
        if T > 1:
            i = max([j for j in range(T - 1) if self.nodes[j] <= g], default=0)
            t, above = clamp((g - self.nodes[i]) / (self.nodes[i + 1] - self.nodes[i]), 0.0, 1.0), 1
        if F == 1:
            return [(i, 1 - t), (i + above, t)]
        c = F * (0.5 + 0.5 * a(y, x))
        k = math.floor(c)
        s = c - k
        k = k % F
        after = (k + 1) % F
        return [(i * F + k, (1 - t) * (1 - s)), (i * F + after, (1 - t) * s),
                ((i + above) * F + k, t * (1 - s)), ((i + above) * F + after, t * s)]

    def view(self, direction):
        wo = direction_of(direction)
        if wo is None or not (0.999 < wo[0] * wo[0] + wo[1] * wo[1] + wo[2] * wo[2] < 1.001 and wo[2] > 0):
            return None
        out, rows = View(), self.rows(wo)
        out.wo = wo
        if self.rows_of_views is not None:
            mixture = [(self.bins[b][0], weight * self.bins[b][1]) for b, weight in rows]
            out.mixture = [(row, weight) for row, weight in mixture if weight > 0]
        else:
            out.tree = self.bins[max(rows, key=lambda pair: pair[1])[0]][0]
        out.tau = (wo[0], wo[1]) if self.F == 1 and wo[0] * wo[0] + wo[1] * wo[1] > 0 else (1.0, 0.0)
        return out

    def place(self, view, wi):
        """None: nowhere."""
        if wi is None or not 0.999 < wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2] < 1.001:
            return None
        out = Place()
        h = [o + i for o, i in zip(view.wo, wi)]
        out.length = math.sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2])
        if out.length == 0:
            return None
        b = -1.0 if h[2] < 0 else 1.0
        hx = b * (view.tau[0] * h[0] + view.tau[1] * h[1])
        hy = b * (view.tau[0] * h[1] - view.tau[1] * h[0])
        alpha, sign = a(abs(hy), hx), -1.0 if hy < 0 else 1.0
        out.X = self.W * alpha if self.mirrored else self.W * (0.5 + 0.5 * sign * alpha)
        out.Y = self.H * ((h[0] * h[0] + h[1] * h[1]) / (out.length * (out.length + abs(h[2]))))
        out.dot = abs(view.wo[0] * h[0] + view.wo[1] * h[1] + view.wo[2] * h[2])
        out.wi = wi
        return out

    def density(self, place, p, box, s):
        D = 0.0
        if p > 0:
            (x0, x1), (y0, y1) = box
            numerator, area = p * self.W * self.H * place.length, (x1 - x0) * (y1 - y0)
            D = numerator / (8 * PI * place.dot * area) if place.dot > 0 else math.inf
            for axis, at in enumerate((place.X, place.Y)):
                low, high = box[axis]
                if s[axis] != 0:
                    D = D * slope(s[axis], clamp((at - low) / (high - low), 0.0, 1.0))
        if self.sigma > 0:
            D = (1 - self.sigma) * D + self.sigma / PI * max(0.0, place.wi[2])
        return pdf32(D) if p > 0 else 0.0 if D <= 1.17549435e-38 else f32(D)

    def whole(self):
        return [[0, self.W], [0, self.H]], [0.0, 0.0]

    def view_pdf(self, view, wi):
        """The density that is found for wi."""
        place = self.place(view, wi)
        if place is None:
            return 0.0
        box, s = self.whole()
        square = [min(math.floor(place.X), self.W - 1), min(math.floor(place.Y), self.H - 1)]
        if self.rows_of_views is not None:
            square[1] = bisect.bisect_right(self.begins, place.Y, 0, ROWS) - 1
        if view.mixture is None:
            p = self.tree.find(view.tree, square, box, s)
        elif not view.mixture:
            p = 0.0
        else:
            tile, p = self.rows_of_views.find(view.mixture, square)
            if p > 0:
                p = self.rows_of_views.find_within(self.tree, tile, p, square, box, s)
                box[1] = [self.begins[row] for row in box[1]]
        return self.density(place, p, box, s)

    def pdf(self, wo, wi):
        view = self.view(wo)
        return self.view_pdf(view, direction_of(wi)) if view else 0.0

    def sample(self, wo, u0, u1):
        view, u, sign = self.view(wo), [random_number(u0), random_number(u1)], 1.0
        if view is None:
            return NOTHING
        if self.sigma > 0 and u[1] < self.sigma:  # step 1
            v = min(u[1] / self.sigma, 1 - 2.0**-40)
            sine, cosine = sin_cos(2 * u[0] - 1)
            wi = [f32(math.sqrt(v) * cosine), f32(math.sqrt(v) * sine), f32(math.sqrt(1 - v))]
            return (*wi, self.view_pdf(view, wi))
        if self.sigma > 0:  # step 2
            u[1] = (u[1] - self.sigma) / (1 - self.sigma)
        if view.mixture is not None and not view.mixture:  # step 3
            return NOTHING
        if self.mirrored:  # step 4
            v = 2 * u[0] - 1
            sign, u[0] = -1.0 if v < 0 else 1.0, abs(v)
        box, s = self.whole()
        if view.mixture is not None:  # step 5
            tile, p = self.rows_of_views.draw(view.mixture, u)
            p = self.rows_of_views.sample_within(self.tree, tile, p, u, box, s)
            box[1] = [self.begins[row] for row in box[1]]
        else:
            p = self.tree.draw(view.tree, u, box, s)
        t = [clamp(fraction_sampled(u[i], s[i]), 2.0**-30, 1 - 2.0**-30) for i in (0, 1)]
        for _ in range(32):  # step 6
            x, y = (low + ti * (high - low) for ti, (low, high) in zip(t, box))
            wi = self.reflected(view, x, y, sign)
            place = self.place(view, wi)
            if place and box[0][0] <= place.X < box[0][1] and box[1][0] <= place.Y < box[1][1]:
                return (*wi, self.density(place, p, box, s))  # step 7
            t = [0.5 + 0.75 * (ti - 0.5) for ti in t]
        return (*wi, self.view_pdf(view, wi) or f32(1.17549435e-38))

    def reflected(self, view, x, y, sign):
        sine, cosine = sin_cos(sign * x / self.W if self.mirrored else 2 * x / self.W - 1)
        q = y / self.H
        tx, ty = view.tau
        r = math.sqrt(q * (2 - q)) / math.sqrt(tx * tx + ty * ty)
        h = (r * (tx * cosine - ty * sine), r * (ty * cosine + tx * sine), 1 - q)
        dot = 2 * (view.wo[0] * h[0] + view.wo[1] * h[1] + view.wo[2] * h[2])
        return [f32(dot * hi - oi) for hi, oi in zip(h, view.wo)]

    def albedo(self, wo):
        direction = self.view(wo)
        if direction is None:
            return 0.0
        total = sum(weight * self.bins[b][1] * self.total for b, weight in self.rows(direction.wo))
        return min(total, 1.7976931348623157e+308)
