# profiling/report/render.py - spheres and cut-open bodies as pixels, in plain numpy: no display, no graphics library.
"""A parallel projection with a depth buffer. Every sphere is exact in each pixel; bodies are drawn behind a cut plane, and
where the plane passes through a solid its section is filled."""
import numpy as np

SURFACE = np.array([0.905, 0.915, 0.93])
SECTION = np.array([0.66, 0.69, 0.73])
LIGHT = np.array([-0.45, 0.65, 0.62]) / np.linalg.norm([-0.45, 0.65, 0.62])    # right, up, towards the viewer


class Camera:
    """Looks horizontally along +y, turned by `azimuth` about z and looking down by `elevation` [rad]."""

    def __init__(self, azimuth=0.0, elevation=0.0):
        ca, sa, ce, se = np.cos(azimuth), np.sin(azimuth), np.cos(elevation), np.sin(elevation)
        # Rows: right, up, towards the viewer.
        self.axes = np.array([[ca, sa, 0], [-sa * se, ca * se, ce], [sa * ce, -ca * ce, se]])

    def view(self, points):
        return points @ self.axes.T


class Canvas:
    """Pixels that cover the rectangle low .. high (right, up) [m] of the camera's view."""

    def __init__(self, camera, low, high, width):
        self.camera, self.low, self.high = camera, np.asarray(low, float), np.asarray(high, float)
        self.scale = width / (self.high[0] - self.low[0])                        # pixels per metre
        self.shape = int(np.ceil((self.high[1] - self.low[1]) * self.scale)), int(width)
        self.depth = np.full(self.shape, -np.inf)                                # towards the viewer [m]
        self.color = np.ones((*self.shape, 3))

    def to_pixels(self, points):
        seen = self.camera.view(points)
        seen[..., :2] = (seen[..., :2] - self.low) * self.scale - 0.5            # pixel k has its centre at k
        return seen

    def bodies(self, triangles, closed, cut):
        """Draws what of the bodies has y > cut. Only closed surfaces have a section and an inner side that is not seen."""
        there = triangles[:, :, 1].max(axis=1) > cut
        beyond = triangles[there]
        # Surfaces turned away from the viewer minus surfaces turned to him, along the ray from the cut plane: positive where the
        # plane cuts a solid (the capping trick of stencil buffers, for parts that may overlap).
        inside = np.zeros(self.shape, int)
        for corners, seen, solid in zip(beyond, self.to_pixels(beyond), closed[there]):
            self._triangle(corners, seen, cut, inside if solid else None)
        self.color[inside > 0] = SECTION
        toward = self.camera.axes[2]
        if toward[1] < 0:
            self.depth[inside > 0] = self._cut_depth(cut)[inside > 0]

    def _cut_depth(self, cut):
        # Depth at which the ray of each pixel meets the plane: y = right * axes[0].y + up * axes[1].y + depth * axes[2].y.
        rows, columns = np.mgrid[: self.shape[0], : self.shape[1]]
        right, up = (np.stack([columns, rows]) + 0.5) / self.scale + self.low[:, None, None]
        return (cut - right * self.camera.axes[0, 1] - up * self.camera.axes[1, 1]) / self.camera.axes[2, 1]

    def _triangle(self, corners, seen, cut, inside):
        a, b, c = seen[:, :2]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-9:
            return
        first = np.maximum(np.ceil(seen[:, :2].min(axis=0)).astype(int), 0)
        last = np.minimum(np.floor(seen[:, :2].max(axis=0)).astype(int), np.array(self.shape[::-1]) - 1)
        if (first > last).any():
            return
        x, y = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1))
        weight = np.stack([(c[0] - b[0]) * (y - b[1]) - (c[1] - b[1]) * (x - b[0]),
                           (a[0] - c[0]) * (y - c[1]) - (a[1] - c[1]) * (x - c[0]),
                           (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])]) / area
        covered = self._owns(weight, (b - c, c - a, a - b), np.sign(area)) & (np.tensordot(corners[:, 1], weight, 1) > cut)
        window = np.s_[first[1] : last[1] + 1, first[0] : last[0] + 1]
        if inside is not None:
            inside[window] -= int(np.sign(area)) * covered
            if area < 0:
                return
        depth = np.tensordot(seen[:, 2], weight, 1)
        nearer = covered & (depth > self.depth[window])
        self.depth[window][nearer] = depth[nearer]
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normal = self.camera.view(normal / np.linalg.norm(normal)) * np.sign(area)
        self.color[window][nearer] = SURFACE * (0.86 + 0.14 * max(0.0, normal @ LIGHT))

    @staticmethod
    def _owns(weight, edges, sign):
        # A pixel on the common edge of two triangles belongs to one of them only, or `inside` would count it twice.
        covered = np.ones(weight.shape[1:], bool)
        for w, (dx, dy) in zip(weight, edges):
            covered &= (w > 0) | ((w == 0) & ((dy * sign > 0) | ((dy == 0) & (dx * sign > 0))))
        return covered

    def spheres(self, position, radius, color):
        """Draws spheres; color has a row (red, green, blue; 0 .. 1) for each."""
        seen = self.to_pixels(position)
        pixels = radius * self.scale
        key = np.full(self.shape, -1, np.int64)                                  # depth in the high bits, row in the low ones
        low, high = (seen[:, 2] - radius).min(), (seen[:, 2] + radius).max()
        reach = np.ceil(pixels).astype(int) + 1
        for size in np.unique(reach):
            members = np.flatnonzero(reach == size)
            offset = np.arange(-size, size + 1)
            for block in np.array_split(members, 1 + len(members) * len(offset) ** 2 // 4_000_000):
                centre = np.rint(seen[block, :2]).astype(int)
                x = centre[:, 0, None, None] + offset[None, None, :]
                y = centre[:, 1, None, None] + offset[None, :, None]
                x, y = np.broadcast_arrays(x, y)
                dx, dy = x - seen[block, 0, None, None], y - seen[block, 1, None, None]
                height = pixels[block, None, None] ** 2 - dx**2 - dy**2
                hit = (height > 0) & (x >= 0) & (y >= 0) & (x < self.shape[1]) & (y < self.shape[0])
                row = np.broadcast_to(block[:, None, None], hit.shape)[hit]
                depth = seen[row, 2] + np.sqrt(height[hit]) / self.scale
                level = ((depth - low) / (high - low) * (2**31 - 1)).astype(np.int64)
                np.maximum.at(key, (y[hit], x[hit]), level << 32 | row)
        y, x = np.nonzero(key >= 0)
        row = key[y, x] & 0xFFFFFFFF
        dx, dy = x - seen[row, 0], y - seen[row, 1]
        normal = np.stack([dx, dy, np.sqrt(np.maximum(0, pixels[row] ** 2 - dx**2 - dy**2))], axis=1) / pixels[row, None]
        depth = seen[row, 2] + normal[:, 2] * radius[row]
        front = depth > self.depth[y, x]
        y, x, row, normal = y[front], x[front], row[front], normal[front]
        self.depth[y, x] = depth[front]
        brightness = 0.45 + 0.6 * np.maximum(0, normal @ LIGHT)
        shine = 0.25 * np.maximum(0, normal @ ((LIGHT + [0, 0, 1]) / np.linalg.norm(LIGHT + [0, 0, 1]))) ** 30
        self.color[y, x] = np.clip(color[row] * brightness[:, None] + shine[:, None], 0, 1)

    def shade(self, reach, strength=0.3):
        """Darkens what lies deeper than its surroundings within `reach` [m] (unsharp masking of depth, Luft et al. 2006)."""
        drawn = np.isfinite(self.depth)
        if not drawn.any():
            return
        depth = np.where(drawn, self.depth, self.depth[drawn].min())
        near = depth
        for axis in (0, 1) * 3:
            near = running_mean(near, max(1, round(0.7 * reach * self.scale)), axis)
        buried = np.clip((near - depth) / reach, 0, 1)
        self.color[drawn] *= 1 - strength * buried[drawn, None]

    def image(self, samples):
        """The picture, top row first, with samples x samples pixels averaged into one."""
        rows, columns = self.shape[0] // samples * samples, self.shape[1] // samples * samples
        blocks = self.color[:rows, :columns].reshape(rows // samples, samples, columns // samples, samples, 3)
        return blocks.mean(axis=(1, 3))[::-1]


def running_mean(values, reach, axis):
    """Mean over 2 reach + 1 neighbours along an axis; the border's values go on outside."""
    padded = np.pad(values, [(reach + 1, reach) if k == axis else (0, 0) for k in range(values.ndim)], mode="edge")
    total = np.cumsum(padded, axis=axis)
    width = 2 * reach + 1
    upto, before = (np.take(total, range(k, k + total.shape[axis] - width), axis) for k in (width, 0))
    return (upto - before) / width
