# SPDX-License-Identifier: MIT
"""Vertex and index lists for the scenes; all windings are counter-clockwise seen from the front."""

import math

from gltf_writer import cross, normalize, subtract

QUAD_INDICES = [0, 1, 2, 0, 2, 3]
QUAD_UVS = [(0, 1), (1, 1), (1, 0), (0, 0)]


def quad(origin, right, up):
    """Corners of a parallelogram facing cross(right, up): bottom left, bottom right, top right, top left."""
    return [tuple(o + a * r + b * u for o, r, u in zip(origin, right, up)) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]


def quad_normals(corners):
    return [normalize(cross(subtract(corners[1], corners[0]), subtract(corners[3], corners[0])))] * 4


def ground(half_x, half_z, y=0.0):
    """A rectangle about the origin facing +y, image top at its far (-z) edge."""
    return quad((-half_x, y, half_z), (2 * half_x, 0, 0), (0, 0, -2 * half_z))


def join_quads(quads):
    """Positions and indices of many quads without shared vertices."""
    positions = [corner for corners in quads for corner in corners]
    return positions, [4 * i + k for i in range(len(quads)) for k in QUAD_INDICES]


def box_faces(low, high):
    """The six faces of a box, outward, each with its image upright seen from the side."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    w, h, d = x1 - x0, y1 - y0, z1 - z0
    return [quad((x0, y0, z1), (w, 0, 0), (0, h, 0)), quad((x1, y0, z1), (0, 0, -d), (0, h, 0)),
            quad((x1, y0, z0), (-w, 0, 0), (0, h, 0)), quad((x0, y0, z0), (0, 0, d), (0, h, 0)),
            quad((x0, y1, z1), (w, 0, 0), (0, 0, -d)), quad((x0, y0, z0), (w, 0, 0), (0, 0, d))]


def flip(corners):
    """The same quad facing the other way."""
    return [corners[1], corners[0], corners[3], corners[2]]


def icosphere(radius, subdivisions):
    """20 * 4^subdivisions triangles, a convex polyhedron with all corners on the sphere."""
    golden = (1 + math.sqrt(5)) / 2
    points = [normalize(p) for p in ((-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0),
                                     (0, -1, golden), (0, 1, golden), (0, -1, -golden), (0, 1, -golden),
                                     (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1))]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
             (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
             (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                points.append(normalize(tuple(x + y for x, y in zip(points[a], points[b]))))
                middles[key] = len(points) - 1
            return middles[key]

        faces = [f for a, b, c in faces for ab, bc, ca in ((middle(a, b), middle(b, c), middle(c, a)),)
                 for f in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
    return [tuple(radius * x for x in p) for p in points], [i for face in faces for i in face]


def bumpy_ball(columns, rows, radius, centre):
    """A closed ball of 2 * columns * (rows - 1) triangles with bumps of two sizes, shared vertices."""
    def point(longitude, latitude):
        r = radius * (1 + 0.1 * math.sin(9 * longitude) * math.sin(7 * latitude)
                      + 0.02 * math.sin(60 * longitude) * math.sin(50 * latitude))
        direction = (math.sin(latitude) * math.cos(longitude), math.cos(latitude), math.sin(latitude) * math.sin(longitude))
        return tuple(c + r * d for c, d in zip(centre, direction))

    positions = [point(2 * math.pi * i / columns, math.pi * j / rows) for j in range(1, rows) for i in range(columns)]
    north, south = len(positions), len(positions) + 1
    positions += [point(0, 0), point(0, math.pi)]
    last = (rows - 2) * columns
    indices = []
    for i in range(columns):
        right = (i + 1) % columns
        indices += [north, right, i, last + i, last + right, south]
        for above in range(0, last, columns):
            a, b, c, d = above + i, above + right, above + columns + i, above + columns + right
            indices += [a, b, c, b, d, c]
    return positions, indices


def torus_knot(around, along, ring, tube, bump):
    """A closed bumpy tube along a (2,3) torus knot: 2 * around * along triangles, shared vertices."""
    def curve(t):
        distance = ring + math.cos(3 * t)
        return (distance * math.cos(2 * t), distance * math.sin(2 * t), math.sin(3 * t))

    positions = []
    for i in range(along):
        t = 2 * math.pi * i / along
        centre = curve(t)
        tangent = normalize(subtract(curve(t + 1e-4), curve(t - 1e-4)))
        # The direction away from the torus's own core is periodic, so the tube closes without a twist.
        core = (ring * math.cos(2 * t), ring * math.sin(2 * t), 0.0)
        side = normalize(cross(tangent, subtract(centre, core)))
        out = cross(side, tangent)
        for j in range(around):
            phi = 2 * math.pi * j / around
            radius = tube * (1 + bump * math.sin(24 * t) * math.cos(3 * phi))
            c, s = radius * math.cos(phi), radius * math.sin(phi)
            positions.append(tuple(p + c * o + s * q for p, o, q in zip(centre, out, side)))
    indices = []
    for i in range(along):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = (i + 1) % along * around + j, (i + 1) % along * around + (j + 1) % around
            indices += [a, b, d, a, d, c]
    return positions, indices


def faces_point(corners, point):
    """Whether a point lies in front of a quad."""
    normal = quad_normals(corners)[0]
    centre = tuple(sum(c[i] for c in corners) / 4 for i in range(3))
    return sum(n * (p - c) for n, p, c in zip(normal, point, centre)) > 0


def turned_towards(corners, point):
    return corners if faces_point(corners, point) else flip(corners)


def turned_away(corners, point):
    return flip(corners) if faces_point(corners, point) else corners


def prism_faces(base, height):
    """The six outward faces over a four-cornered base given as (x, z), standing on y = base height."""
    outline, y0 = base
    y1 = y0 + height
    low, high = [[(x, y, z) for x, z in outline] for y in (y0, y1)]
    centre = tuple(sum(p[i] for p in low + high) / 8 for i in range(3))
    sides = [[low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]] for i in range(4)]
    return [turned_away(face, centre) for face in [high, low] + sides]
