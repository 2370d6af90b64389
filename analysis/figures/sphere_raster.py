"""Spheres, viewed along -z, painted into a pixel image with a depth buffer: the cost is pixels times spheres,
not objects."""

import numpy as np

_SMALL = 4.0  # pixels: smaller spheres are painted together, one pixel of each at a time
_LIGHT = np.array([-0.45, 0.55, 0.70]) / np.linalg.norm([-0.45, 0.55, 0.70])


def paint_spheres(position, radius, colour, window, pixel, fading=4.0):
    """Image (H,W,3) of floats 0 to 1, row 0 at the smallest y, of spheres viewed from large z (orthographic).

    position (N,3), radius (N,), window (x0, x1, y0, y1) and pixel (edge length) in one unit; colour (N,3) 0
    to 1. Spheres are shaded by a light from the upper left, and darker the deeper they lie: over `fading` radii of the
    largest."""
    x0, x1, y0, y1 = window
    width, height = max(1, int(round((x1 - x0) / pixel))), max(1, int(round((y1 - y0) / pixel)))
    depth, owner = np.full(width * height, -np.inf), np.full(width * height, -1, dtype=np.intp)
    if len(radius):
        spheres = position, radius, (x0, y0), (width, height), pixel
        for _, pixels, z in _covered(*spheres):
            np.maximum.at(depth, pixels, z)
        for rows, pixels, z in _covered(*spheres):
            front = z == depth[pixels]
            owner[pixels[front]] = rows[front]
    image = np.ones((height * width, 3))
    hit = np.flatnonzero(owner >= 0)
    if hit.size:
        image[hit] = _shade(hit, depth[hit], owner[hit], position, radius, colour, (x0, y0), width, pixel, fading)
    return image.reshape(height, width, 3)


def _covered(position, radius, origin, size, pixel):
    """Spheres (rows), pixels of the image that they cover, and the surface's z there, in parts: those of all small
    spheres at one offset from their central pixel, and each larger sphere by itself."""
    column, row = ((position[:, k] - origin[k]) / pixel for k in (0, 1))
    # At least one pixel each: a grain smaller than a pixel must not vanish.
    pixels = np.maximum(radius / pixel, 0.75)

    def covered(rows, c, r):
        left = pixels[rows] ** 2 - (c + 0.5 - column[rows]) ** 2 - (r + 0.5 - row[rows]) ** 2
        shown = (left > 0) & (c >= 0) & (c < size[0]) & (r >= 0) & (r < size[1])
        rows, c, r = rows[shown], c[shown], r[shown]
        return rows, r * size[0] + c, position[rows, 2] + pixel * np.sqrt(left[shown])

    inside = (column > -pixels) & (column < size[0] + pixels) & (row > -pixels) & (row < size[1] + pixels)
    small = np.flatnonzero(inside & (pixels <= _SMALL))
    central = np.floor(column[small]).astype(np.intp), np.floor(row[small]).astype(np.intp)
    reach = int(np.ceil(pixels[small].max(initial=0.0)))
    for j in range(-reach, reach + 1):
        for i in range(-reach, reach + 1):
            yield covered(small, central[0] + i, central[1] + j)
    for sphere in np.flatnonzero(inside & (pixels > _SMALL)):
        low, high = (np.array([column[sphere], row[sphere]]) + sign * (pixels[sphere] + 1) for sign in (-1, 1))
        columns, rows = (np.arange(int(max(0, a)), int(min(n, b))) for a, b, n in zip(low, high, size))
        c, r = np.tile(columns, rows.size), np.repeat(rows, columns.size)
        yield covered(np.full(c.size, sphere), c, r)


def _shade(hit, depth, owner, position, radius, colour, origin, width, pixel, fading):
    centre = np.stack(
        [origin[0] + (hit % width + 0.5) * pixel, origin[1] + (hit // width + 0.5) * pixel, depth], axis=1
    )
    normal = centre - position[owner]
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    light = 0.45 + 0.55 * np.clip(normal @ _LIGHT, 0.0, 1.0)
    front, back = depth.max(), depth.min()
    # So far behind the front, a sphere has lost most of its light.
    fade = 0.30 + 0.70 * np.exp(-(front - depth) / (fading * radius.max())) if front > back else 1.0
    return np.clip(colour[owner] * (light * fade)[:, None], 0.0, 1.0)
