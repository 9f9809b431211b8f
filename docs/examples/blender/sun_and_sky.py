"""Takes the sun out of a world's picture: its texture becomes an .acdf, the cone in which that takes most of its samples a sun
lamp, and what is left the world's new texture. The light is the same; the lamp is sampled by itself.

    blender -b scene.blend -P sun_and_sky.py -- [--budget 16KiB] [--least 0.1] [--widest 5] -o out.blend

Needs the Python package acdf where Blender's Python finds it (Debian: python3-acdf; else --python-use-system-env and
PYTHONPATH). The world has an environment texture, equirectangular; a Mapping node may rotate it."""
import argparse
import os
import sys

import bpy
import numpy as np
from mathutils import Matrix, Vector

import acdf

SAMPLES = 1 << 16


def texture_of(world):
    for node in world.node_tree.nodes:
        if node.bl_idname == "ShaderNodeTexEnvironment" and node.image and node.outputs["Color"].is_linked:
            if node.projection != "EQUIRECTANGULAR":
                raise SystemExit(f"{node.image.name}: the projection is {node.projection}, not EQUIRECTANGULAR")
            return node
    raise SystemExit(f"world {world.name}: no environment texture")


def strength_of(world):
    for node in world.node_tree.nodes:
        if node.bl_idname == "ShaderNodeBackground":
            return node.inputs["Strength"].default_value
    return 1.0


def rotation_of(node):
    """From directions of the world to those of the picture."""
    if not node.inputs["Vector"].is_linked:
        return Matrix.Identity(3)
    mapping = node.inputs["Vector"].links[0].from_node
    if mapping.bl_idname != "ShaderNodeMapping":
        return Matrix.Identity(3)
    return mapping.inputs["Rotation"].default_value.to_matrix()


def pixels_of(image):
    """(height, width, 3), rows from the top."""
    width, height = image.size
    flat = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(height, width, image.channels)[::-1, :, :3].copy()


def directions_of(height, width):
    """Of the texels' middles, (height, width, 3), and their solid angles, (height, 1). Blender's frame is that of acdf."""
    theta = (np.arange(height)[:, None] + 0.5) * np.pi / height
    phi = np.pi - (np.arange(width)[None, :] + 0.5) * 2 * np.pi / width
    edges = np.cos(np.arange(height + 1) * np.pi / height)
    towards = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)
    return towards, (edges[:-1] - edges[1:])[:, None] * (2 * np.pi / width)


def find_sun(sky, widest):
    """The cone about the densest sample: its axis, its radius in radians, and its share of all samples."""
    directions, pdf = sky.sample(np.random.default_rng(1).random((SAMPLES, 2)))
    near = directions @ directions[pdf.argmax()] > np.cos(widest)
    axis = directions[near].mean(0)
    axis /= np.linalg.norm(axis)
    angles = np.sort(np.arccos(np.clip(directions @ axis, -1, 1)))
    angles = angles[angles <= widest]
    # Where a cone holds more of the samples than an even light would by the most: Kolmogorov's distance.
    even = (1 - np.cos(angles)) / (1 - np.cos(widest))
    best = (np.arange(1, len(angles) + 1) / len(angles) - even).argmax()
    return axis, float(angles[best]), (best + 1) / SAMPLES


def split(pixels, axis, radius):
    """Pixels without the sun, and its irradiance, (3,), on what faces it."""
    towards, solid_angle = directions_of(*pixels.shape[:2])
    angle = np.arccos(np.clip(towards @ axis, -1, 1))
    reach = radius + 2 * np.pi / pixels.shape[0]  # filters spread it over a texel
    ring = pixels[(angle > reach) & (angle <= 2 * reach + 0.02)]
    rest = np.where((angle <= reach)[..., None], np.minimum(pixels, np.median(ring, 0)), pixels)
    return rest, ((pixels - rest) * solid_angle[..., None]).sum((0, 1), np.float64)


def add_sun(axis, radius, irradiance):
    lamp = bpy.data.lights.new("acdf sun", "SUN")
    lamp.energy = float(irradiance.max())
    lamp.color = irradiance / irradiance.max()
    lamp.angle = 2 * radius
    thing = bpy.data.objects.new("acdf sun", lamp)
    thing.rotation_euler = Vector(axis).to_track_quat("Z", "Y").to_euler()  # a lamp shines down its z axis
    bpy.context.scene.collection.objects.link(thing)


def set_texture(node, pixels, path):
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(os.path.basename(path), width, height, alpha=False, float_buffer=True)
    image.colorspace_settings.name = node.image.colorspace_settings.name
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width), np.float32)])[::-1].astype(np.float32).ravel())
    image.file_format = "OPEN_EXR"
    image.filepath_raw = path
    image.save()
    node.image = image


def main(arguments):
    parser = argparse.ArgumentParser(prog="sun_and_sky.py", description="Takes the sun out of a world's picture.")
    parser.add_argument("--budget", default="16KiB", help="of the .acdf (default: 16KiB)")
    parser.add_argument("--least", type=float, default=0.1, help="share of the light that makes a sun (default: 0.1)")
    parser.add_argument("--widest", type=float, default=5.0, help="radius of a sun, degrees (default: 5)")
    parser.add_argument("-o", "--output", required=True, help="the .blend; pictures and the .acdf lie beside it")
    options = parser.parse_args(arguments)
    world = bpy.context.scene.world
    node = texture_of(world)
    pixels = pixels_of(node.image)
    stem = os.path.splitext(os.path.abspath(options.output))[0]
    sky = acdf.build_environment(pixels, budget=options.budget, filter="bilinear", channel="average")
    sky.save(stem + ".acdf")
    axis, radius, share = find_sun(sky, np.radians(options.widest))
    if share < options.least:
        print(f"no sun: {share:.0%} of the light within {np.degrees(radius):.2f} degrees")
    else:
        rest, irradiance = split(pixels, axis, radius)
        add_sun(rotation_of(node).transposed() @ Vector(axis), radius, irradiance * strength_of(world))
        set_texture(node, rest, stem + "_sky.exr")
        print(f"sun: {share:.0%} of the light within {np.degrees(radius):.2f} degrees of "
              f"({axis[0]:.4f}, {axis[1]:.4f}, {axis[2]:.4f})")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(options.output))


main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
