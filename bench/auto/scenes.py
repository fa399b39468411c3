"""Writes six drawn scenes as OBJ files: rooms with mirrors whose shapes and positions are drawn from a seed."""
import math
import os
import random

GREY, LAMP, MIRROR = "wall", "lamp", "mirror"
MATERIALS = """newmtl wall
Kd .7 .68 .65
newmtl red
Kd .65 .12 .1
newmtl blue
Kd .12 .2 .6
newmtl lamp
Kd 0 0 0
Ke 9 8 7
newmtl mirror
Kd 0 0 0
Ks 1 1 1
illum 3
"""


class Writer:
    """Collects the objects of one OBJ file. Each object has a name, a material and faces."""

    def __init__(self):
        self.lines, self.places, self.normals = ["mtllib drawn.mtl"], 0, 0

    def add(self, name, material, places, normals, faces):
        """Adds an object. Each face is a list of index pairs (position, normal), counted from 0 within the object."""
        self.lines += [f"o {name}", f"usemtl {material}"]
        self.lines += ["v %.6f %.6f %.6f" % tuple(p) for p in places] + ["vn %.6f %.6f %.6f" % tuple(n) for n in normals]
        for face in faces:
            self.lines.append("f " + " ".join(f"{p + 1 + self.places}//{n + 1 + self.normals}" for p, n in face))
        self.places, self.normals = self.places + len(places), self.normals + len(normals)

    def quad(self, name, material, corners):
        a, b, c = corners[:3]
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        size = math.sqrt(sum(x * x for x in n))
        self.add(name, material, corners, [[x / size for x in n]], [[(i, 0) for i in range(4)]])

    def box(self, name, material, low, high, inwards=False):
        places = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
        sides = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
        normals = [[(-1, 1)[i % 2] * (-1 if inwards else 1) if k == i // 2 else 0 for k in range(3)] for i in range(6)]
        faces = [[(p, i) for p in (reversed(side) if inwards else side)] for i, side in enumerate(sides)]
        self.add(name, material, places, normals, faces)

    def surface(self, name, material, place, columns, rows):
        """Adds a smooth surface. The function `place` maps u and v, from 0 to 1, to a position and a normal."""
        points = [place(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        at = lambda i, j: (j * (columns + 1) + i,) * 2
        faces = [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for j in range(rows) for i in range(columns)]
        self.add(name, material, [p for p, _ in points], [n for _, n in points], faces)

    def ball(self, name, material, centre, radius, columns=48, rows=24):
        def place(u, v):
            n = [math.sin(math.pi * v) * math.cos(2 * math.pi * u), -math.cos(math.pi * v),
                 -math.sin(math.pi * v) * math.sin(2 * math.pi * u)]
            return [centre[k] + radius * n[k] for k in range(3)], n
        self.surface(name, material, place, columns, rows)

    def ring(self, name, material, centre, large, small, columns=64, rows=24):
        def place(u, v):
            a, b = 2 * math.pi * u, 2 * math.pi * v
            n = [math.cos(b) * math.cos(a), math.sin(b), -math.cos(b) * math.sin(a)]
            spoke = [math.cos(a), 0, -math.sin(a)]
            return [centre[k] + large * spoke[k] + small * n[k] for k in range(3)], n
        self.surface(name, material, place, columns, rows)

    def drum(self, name, material, centre, radius, height, columns=48):
        def place(u, v):
            n = [math.cos(2 * math.pi * u), 0, -math.sin(2 * math.pi * u)]
            return [centre[0] + radius * n[0], centre[1] + height * (v - .5), centre[2] + radius * n[2]], n
        self.surface(name, material, place, columns, 2)


def room(writer, size):
    writer.box("room", GREY, [0, 0, 0], size, inwards=True)
    middle, edge = [size[0] / 2, size[2] / 2], min(size[0], size[2]) / 8
    x, z, y = *middle, size[1] - .01
    writer.quad("lamp", LAMP, [[x - edge, y, z - edge], [x + edge, y, z - edge], [x + edge, y, z + edge],
                               [x - edge, y, z + edge]])


def things(writer, draw, size, count):
    """Adds diffuse boxes and balls on the floor, at drawn positions."""
    for i in range(count):
        half = draw.uniform(.15, .4)
        x, z = draw.uniform(.5, size[0] - .5), draw.uniform(.5, size[2] - .5)
        colour = draw.choice(["red", "blue", GREY])
        if i % 2:
            writer.ball(f"thing{i}", colour, [x, half, z], half, 24, 12)
        else:
            writer.box(f"thing{i}", colour, [x - half, 0, z - half], [x + half, draw.uniform(.3, 1.4), z + half])


def panel(writer, name, size, wall, along, width, low, high, depth=0):
    """Adds a mirror on a wall of the room. Walls 0 and 1 are perpendicular to x, walls 2 and 3 to z. With a depth, the
    mirror is a closed box instead of a quadrilateral."""
    k = 0 if wall < 2 else 2
    gap, sign = .02, 1 if wall % 2 == 0 else -1
    back = gap if sign > 0 else size[k] - gap
    front = back + sign * depth
    if depth:
        lo, hi = [0, low, 0], [0, high, 0]
        lo[k], hi[k] = min(back, front), max(back, front)
        lo[2 - k], hi[2 - k] = along, along + width
        return writer.box(name, MIRROR, lo, hi)
    corners = []
    for a, y in ((along, low), (along + width, low), (along + width, high), (along, high)):
        corner = [0, y, 0]
        corner[k], corner[2 - k] = back, a
        corners.append(corner)
    if (sign > 0) == (k == 0):
        corners.reverse()  # so that the mirror faces the room
    writer.quad(name, MIRROR, corners)


def corridor(writer, draw):
    size = [2.4, 2.6, 14]
    room(writer, size)
    things(writer, draw, size, 6)
    for i in range(20):
        panel(writer, f"panel{i}", size, i % 2, .4 + i // 2 * 1.35, 1, .4, 2.2)


def balls(writer, draw):
    size = [5, 3, 5]
    room(writer, size)
    things(writer, draw, size, 5)
    for i in range(5):
        radius = draw.uniform(.2, .5)
        writer.ball(f"ball{i}", MIRROR, [.8 + draw.uniform(0, 3.4), radius + draw.uniform(0, 1.2), .6 + .9 * i], radius)


def mixed(writer, draw):
    size = [6, 3, 4]
    room(writer, size)
    things(writer, draw, size, 6)
    panel(writer, "panel", size, 0, 1, 2, .5, 2.2)
    panel(writer, "beside", size, 3, 2.5, 2.2, .5, 2)
    writer.ball("ball", MIRROR, [draw.uniform(2, 3), .5, 1.5], .5)
    writer.drum("drum", MIRROR, [draw.uniform(3.6, 4.6), .7, 2.4], .4, 1.4)


def frames(writer, draw):
    size = [5, 3, 6]
    room(writer, size)
    things(writer, draw, size, 7)
    for i in range(4):
        panel(writer, f"frame{i}", size, i, .8 + draw.uniform(0, 1), draw.uniform(1, 2), .6, 2.1, .04)


def curved(writer, draw):
    size = [5, 3, 5]
    room(writer, size)
    things(writer, draw, size, 5)
    writer.ring("ring", MIRROR, [1.6, .9, 1.8], .7, .25)
    writer.drum("drum", MIRROR, [3.4, .8, 3.2], .5, 1.6)
    writer.ball("ball", MIRROR, [3.4, .4, 1.4], .4)


def outside(writer, draw):
    """Draws a floor without walls and lamp, which only the environment lights."""
    writer.quad("floor", GREY, [[-6, 0, -6], [-6, 0, 6], [6, 0, 6], [6, 0, -6]])
    things(writer, draw, [4, 3, 4], 6)
    writer.box("block", MIRROR, [-2, 0, -1], [-1, 1.5, 0])
    for i in range(3):
        writer.ball(f"ball{i}", MIRROR, [-1 + 1.3 * i, .45, 2.2 - draw.uniform(0, 3)], .45)


SCENES = {"corridor": corridor, "balls": balls, "mixed": mixed, "frames": frames, "curved": curved, "outside": outside}


def write(folder):
    """Writes all six scenes into the folder. Returns their file names by scene name."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "drawn.mtl"), "w") as file:
        file.write(MATERIALS)
    files = {}
    for number, (name, draw_scene) in enumerate(SCENES.items(), 1):
        writer = Writer()
        draw_scene(writer, random.Random(number))
        files[name] = os.path.join(folder, name + ".obj")
        with open(files[name], "w") as file:
            file.write("\n".join(writer.lines) + "\n")
    return files
