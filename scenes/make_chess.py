#!/usr/bin/env python3
"""Writes chess.glb, the model of README's examples: a king, a queen and a pawn, turned on a lathe.

  scenes/make_chess.py chess.glb
"""
import json
import math
import struct
import sys

SIDES = 36  # of a round
STEPS = 4  # of a curve between two points of a profile

# Profiles go from the foot up, as (radius, height) in centimeters. A repeated point is a crease.
FOOT = [(1.7, 0), (1.75, 0.25), (1.75, 0.25), (1.5, 0.5), (1.5, 0.5), (1.6, 0.75), (1.1, 1.05)]
PAWN = FOOT + [(0.6, 1.7), (0.5, 2.5), (0.5, 2.5), (0.95, 2.65), (0.5, 2.85), (0.5, 2.85),
               (0.85, 3.2), (0.9, 3.6), (0.6, 4.15), (0, 4.4)]
QUEEN = FOOT + [(0.75, 2.2), (0.6, 4.2), (0.6, 4.2), (1.1, 4.35), (0.6, 4.6), (0.6, 4.6),
                (0.8, 5.4), (1.25, 6.2), (1.25, 6.2), (0.9, 6.25), (0.5, 6.6), (0.35, 6.75),
                (0.35, 6.75), (0.35, 7.0), (0, 7.15)]
KING = FOOT + [(0.8, 2.4), (0.65, 5.0), (0.65, 5.0), (1.2, 5.15), (0.65, 5.4), (0.65, 5.4),
               (0.8, 6.4), (1.15, 7.2), (1.15, 7.2), (0.9, 7.5), (0.25, 7.75), (0.25, 7.75),
               (0.2, 8.0), (0.5, 8.5), (0, 9.0)]
MATERIALS = {
    "brass": ([0.91, 0.68, 0.33, 1], 1, 0.25),
    "ebony": ([0.03, 0.025, 0.02, 1], 0, 0.2),
    "ivory": ([0.75, 0.68, 0.55, 1], 0, 0.45),
    "walnut": ([0.19, 0.09, 0.045, 1], 0, 0.4),
    "maple": ([0.56, 0.38, 0.2, 1], 0, 0.4),
}


def curve(points):
    """Points of Catmull-Rom curves between creases, with their tangents."""
    parts = [[points[0]]]
    for before, point in zip(points, points[1:]):
        parts.append([point]) if point == before else parts[-1].append(point)
    for part in parts:
        ends = [part[0]] + part + [part[-1]]
        for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
            for step in range(STEPS + (c is part[-1])):
                t = step / STEPS
                p = [((2 - t) * t - 1) * t * a[k] / 2 + ((3 * t - 5) * t * t + 2) * b[k] / 2 +
                     ((4 - 3 * t) * t + 1) * t * c[k] / 2 + (t - 1) * t * t * d[k] / 2
                     for k in (0, 1)]
                q = [((4 - 3 * t) * t - 1) * a[k] / 2 + (9 * t - 10) * t * b[k] / 2 +
                     ((8 - 9 * t) * t + 1) * c[k] / 2 + (3 * t - 2) * t * d[k] / 2 for k in (0, 1)]
                yield p, q


def turned(profile):
    """Positions, normals and triangles of a profile around the y axis."""
    positions, normals, triangles = [], [], []
    rows = list(curve(profile))
    for (radius, height), (along, up) in rows:
        size = math.hypot(along, up) or 1
        for side in range(SIDES + 1):
            angle = 2 * math.pi * side / SIDES
            s, c = math.sin(angle), math.cos(angle)
            positions.append((max(radius, 0) * c / 100, height / 100, max(radius, 0) * s / 100))
            normals.append((up / size * c, -along / size, up / size * s))
    for row in range(len(rows) - 1):
        for side in range(SIDES):
            a = row * (SIDES + 1) + side
            b = a + SIDES + 1
            # At a crease both rows are in one place, and at the tip all points of a row: there
            # a triangle would have no area.
            triangles += [corners for corners in ((a, b, a + 1), (a + 1, b, b + 1))
                          if len({positions[corner] for corner in corners}) == 3]
    return positions, normals, triangles


def box(width, height):
    """A box on its top side's center."""
    positions, normals, triangles = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            first = len(positions)
            for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                p = [0, 0, 0]
                p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = sign, i * sign, j
                positions.append((p[0] * width / 2, (p[1] - 1) * height / 2, p[2] * width / 2))
                normals.append(tuple(sign * (k == axis) for k in range(3)))
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return positions, normals, triangles


class Model:
    def __init__(self):
        self.bytes = b""
        self.json = {"asset": {"version": "2.0", "copyright": "The authors of whit, Apache 2.0"},
                     "extensionsUsed": ["KHR_mesh_quantization"],
                     "extensionsRequired": ["KHR_mesh_quantization"],
                     "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "materials": [], "accessors": [], "bufferViews": []}
        for name, (color, metallic, roughness) in MATERIALS.items():
            self.json["materials"].append({"name": name, "pbrMetallicRoughness": {
                "baseColorFactor": color, "metallicFactor": metallic,
                "roughnessFactor": roughness}})

    def accessor(self, form, rows, kind, component, **more):
        data = b"".join(struct.pack(form, *row) for row in rows)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        if kind == "VEC3":
            view["byteStride"] = struct.calcsize(form)
        self.json["bufferViews"].append(view)
        self.bytes += data + bytes(-len(data) % 4)
        count = len(rows) * (3 if kind == "SCALAR" else 1)
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1,
                                       "componentType": component, "count": count, "type": kind,
                                       **more})
        return len(self.json["accessors"]) - 1

    def mesh(self, name, shape, material):
        positions, normals, triangles = shape
        least = [min(p[k] for p in positions) for k in range(3)]
        most = [max(p[k] for p in positions) for k in range(3)]
        packed = [struct.unpack("<3f", struct.pack("<3f", *v)) for v in (least, most)]
        attributes = {"POSITION": self.accessor("<3f", positions, "VEC3", 5126, min=packed[0],
                                                max=packed[1]),
                      "NORMAL": self.accessor("<3bx", [[round(127 * x) for x in n] for n in normals],
                                                "VEC3", 5120, normalized=True)}
        indices = self.accessor("<3H", triangles, "SCALAR", 5123)
        self.json["meshes"].append({"name": name, "primitives": [
            {"attributes": attributes, "indices": indices,
             "material": list(MATERIALS).index(material)}]})
        return len(self.json["meshes"]) - 1

    def place(self, name, mesh, x, z):
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]))
        self.json["nodes"].append({"name": name, "mesh": mesh, "translation": [x, 0, z]})

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4s5I", b"glTF", 2, 28 + len(text) + len(self.bytes),
                                   len(text), 0x4E4F534A, 0)[:20] + text)
            file.write(struct.pack("<2I", len(self.bytes), 0x004E4942) + self.bytes)


model = Model()
field = 0.045
dark = model.mesh("dark field", box(field, 0.012), "walnut")
light = model.mesh("light field", box(field, 0.012), "maple")
for i in range(9):
    x, z = i % 3 - 1, i // 3 - 1
    model.place(f"field {i}", (light, dark)[(x + z) % 2], x * field, z * field)
model.place("king", model.mesh("king", turned(KING), "brass"), -field, 0)
model.place("queen", model.mesh("queen", turned(QUEEN), "ebony"), 0, -field)
model.place("pawn", model.mesh("pawn", turned(PAWN), "ivory"), field, field)
model.write(sys.argv[1])
