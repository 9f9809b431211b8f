"""scene.py make SKY.pfm OUT.blend: a ground and a cube under a sky, turned. scene.py draw SAMPLES SEED OUT.npy: the open scene by
Cycles, (height, width, 3). Run by Blender: `blender -b ... -P scene.py -- ...`."""
import os
import sys

import bpy
import numpy as np


def picture_of(path):
    """A portable float map, rows from the bottom as Blender's, as a picture of the scene."""
    with open(path, "rb") as file:
        width, height = (int(x) for x in (file.readline(), file.readline())[1].split())
        file.readline()
        pixels = np.frombuffer(file.read(), "<f4").reshape(height, width, 3)
    image = bpy.data.images.new("sky", width, height, alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Linear"
    image.pixels.foreach_set(np.dstack([pixels, np.ones((height, width), np.float32)]).ravel())
    image.pack()
    return image


def make(sky, path):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_plane_add(size=20)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0.5))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (4, -4, 3), (1.1, 0, 0.785)
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    world = bpy.context.scene.world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = picture_of(sky)
    mapping, coordinates = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord")
    mapping.inputs["Rotation"].default_value = (0.1, 0.2, 0.9)
    links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    background = next(node for node in nodes if node.bl_idname == "ShaderNodeBackground")
    background.inputs["Strength"].default_value = 0.5
    links.new(texture.outputs["Color"], background.inputs["Color"])
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(path))


def draw(samples, seed, path):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples, scene.cycles.seed = int(samples), int(seed)
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 1  # light that is reflected once
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 48, 32, 100
    scene.render.film_transparent = True  # the light on things, not the sky behind them
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = os.path.abspath(path) + ".exr"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    flat = np.empty(48 * 32 * image.channels, np.float32)
    image.pixels.foreach_get(flat)
    np.save(path, flat.reshape(32, 48, image.channels)[..., :3])


def main(what, *arguments):
    {"make": make, "draw": draw}[what](*arguments)


main(*sys.argv[sys.argv.index("--") + 1:])
