"""A Blender extension that selects faces of meshes that cross, touch or are near.

Tests are exact: no pair is missed, and none is invented. `pack.py` makes the file that Blender
installs. Scripts can call the operator:

    bpy.ops.mesh.nearmiss_select(test="CROSSING", others=True)
"""

import bmesh
import bpy
import nearmiss
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, PointerProperty, StringProperty

SOURCE = "nearmiss_source"
"""Face attribute from which modified faces know their source. It is there while a mesh is read."""
HAS_SURFACE = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
FOUND = {"CROSSING": "crossing pair", "TOUCHING": "crossing or touching pair", "NEAR": "near pair"}


class Options:
    """Options of the operator, and of the panel."""

    test: EnumProperty(
        name="Test",
        description="Faces to select",
        items=[
            ("CROSSING", "Crossing", "Faces that pass through others"),
            ("TOUCHING", "Crossing or Touching", "Faces that share a point with others"),
            ("NEAR", "Near", "Faces within a distance of others, and those that touch"),
        ],
    )
    distance: FloatProperty(
        name="Distance",
        description="Largest distance of faces that are near, in the world",
        default=0.01,
        min=0.0,
        precision=4,
        subtype="DISTANCE",
    )
    others: BoolProperty(
        name="Other Selected Objects",
        description="Test all selected objects, each against itself and against the others",
    )


class Settings(Options, bpy.types.PropertyGroup):
    """Options that the panel shows, and the lines of the last report."""

    report: StringProperty()


class Surface:
    """Triangles of an object as its modifiers leave it.

    vertices: (n, 3) float32, in coordinates of the object. triangles: (m, 3) int32. polygons: (m,)
    int32, the polygon of each triangle. sources: (p,) int32, for each polygon the face of the mesh
    that it comes from, or -1.
    """

    def __init__(self, context, thing):
        self.object = thing
        if not is_editable(thing):
            self.read(context)
            return
        mesh = thing.data
        numbers = mesh.attributes.new(SOURCE, "INT", "FACE")
        name = numbers.name
        try:
            # Faces that a modifier adds from elsewhere have 0.
            numbers.data.foreach_set("value", np.arange(1, len(mesh.polygons) + 1, dtype=np.int32))
            mesh.update()
            self.read(context, name)
        finally:
            mesh.attributes.remove(mesh.attributes[name])
            mesh.update()

    def read(self, context, source=None):
        evaluated = self.object.evaluated_get(context.evaluated_depsgraph_get())
        mesh = evaluated.to_mesh()
        try:
            mesh.calc_loop_triangles()
            self.vertices = column(mesh.vertices, "co", np.float32, 3)
            self.triangles = column(mesh.loop_triangles, "vertices", np.int32, 3)
            self.polygons = column(mesh.loop_triangles, "polygon_index", np.int32)
            numbers = source and mesh.attributes.get(source)
            self.sources = np.full(len(mesh.polygons), -1, np.int32)
            if numbers:
                self.sources = column(numbers.data, "value", np.int32) - 1
        finally:
            evaluated.to_mesh_clear()

    def body(self, is_world):
        """The body in the world, or as the mesh has it, without rounding."""
        vertices = self.vertices
        if is_world:
            matrix = np.array(self.object.matrix_world, np.float64)
            vertices = vertices @ matrix[:3, :3].T + matrix[:3, 3]
        return nearmiss.Body(vertices, self.triangles, name=self.object.name)


def is_editable(thing):
    """Whether faces can be selected in an object."""
    return thing.type == "MESH" and thing.data.is_editable


def column(rows, name, dtype, width=1):
    """A property of all rows of a collection, as an array."""
    values = np.empty(len(rows) * width, dtype)
    rows.foreach_get(name, values)
    return values.reshape(-1, width) if width > 1 else values


def find(surfaces, test, distance):
    """Number of pairs that a test finds; and for each surface, whether each polygon is in one."""
    is_near = test == "NEAR"
    scene = nearmiss.Scene()
    for surface in surfaces:
        scene.add(surface.body(is_world=is_near or len(surfaces) > 1))
    detector = nearmiss.Detector(scene)
    found = [np.zeros(len(surface.sources), bool) for surface in surfaces]
    count = 0
    if is_near:
        count = mark_near(detector, surfaces, distance, found)
    # An edge can pass through a face far from all other features: that is not near.
    pairs = detector.discrete(adjacent=True, only_crossing=test == "CROSSING")
    sides = []
    for side in (0, 1):
        polygons = np.empty(len(pairs), np.int64)
        for number, surface in enumerate(surfaces):
            mine = pairs.bodies[:, side] == number
            polygons[mine] = surface.polygons[pairs.triangles[mine, side]]
            found[number][polygons[mine]] = True
        sides.append(np.stack([pairs.bodies[:, side], polygons], axis=1))
    if not is_near:
        # Triangles of two polygons may come in either order.
        first, second = sides
        swapped = (first[:, 0] == second[:, 0]) & (first[:, 1] > second[:, 1])
        first[swapped], second[swapped] = second[swapped], first[swapped]
        count = len(np.unique(np.hstack(sides), axis=0))
    return count, found


def mark_near(detector, surfaces, distance, found):
    """Mark polygons that have a feature within the distance; return the number of pairs."""
    pairs = detector.near(distance)
    vertices = detector.geometry(pairs).vertices.astype(np.int64)
    is_edges = pairs.kind == nearmiss.Kind.EDGE_EDGE
    for number, surface in enumerate(surfaces):
        mine = pairs.bodies == number
        near_vertices = pairs.feature_a[~is_edges & mine[:, 0]]
        near_edges = [vertices[is_edges & mine[:, 0], :2], vertices[is_edges & mine[:, 1], 2:]]
        is_near = np.isin(surface.triangles, near_vertices).any(axis=1)
        is_near[pairs.feature_b[~is_edges & mine[:, 1]]] = True
        keys = edge_keys(np.concatenate(near_edges), len(surface.vertices))
        for corners in ([0, 1], [1, 2], [2, 0]):
            own = edge_keys(surface.triangles[:, corners].astype(np.int64), len(surface.vertices))
            is_near |= np.isin(own, keys)
        found[number][surface.polygons[is_near]] = True
    return len(pairs)


def edge_keys(edges, vertex_count):
    """A number for each edge, the same in both directions."""
    return edges.min(axis=1) * vertex_count + edges.max(axis=1)


def select(surfaces, found):
    """Select the sources of polygons in edit mode; return a line for each object."""
    bpy.ops.mesh.select_all(action="DESELECT")
    lines = []
    for surface, polygons in zip(surfaces, found):
        line = f"{surface.object.name}: {count_of(np.count_nonzero(polygons), 'face')}"
        sources = surface.sources[polygons]
        if not (is_editable(surface.object) and surface.object.data.is_editmode):
            sources = np.full(len(sources), -1)
        lost, hidden = np.count_nonzero(sources < 0), 0
        if lost < len(sources):
            mesh = bmesh.from_edit_mesh(surface.object.data)
            mesh.faces.ensure_lookup_table()
            for source in np.unique(sources[sources >= 0]):
                face = mesh.faces[source]
                hidden += face.hide
                face.select_set(not face.hide)
            bmesh.update_edit_mesh(surface.object.data, loop_triangles=False, destructive=False)
        line += f", {hidden:,} hidden" if hidden else ""
        lines.append(line + (f", {lost:,} that cannot be selected" if lost else ""))
    return lines


def count_of(number, noun):
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


class MESH_OT_nearmiss_select(Options, bpy.types.Operator):
    """Select faces that cross others, touch them or are near, by exact tests"""

    bl_idname = "mesh.nearmiss_select"
    bl_label = "Select Crossing Faces"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        thing = context.active_object
        is_mode = context.mode in {"OBJECT", "EDIT_MESH"}
        if is_mode and thing is not None and is_editable(thing) and thing.visible_get():
            return True
        cls.poll_message_set("The active object must be a visible mesh, in object or edit mode")
        return False

    def execute(self, context):
        things, mode = [context.active_object], context.mode
        # Changes of edit mode reach the mesh when that mode ends.
        bpy.ops.object.mode_set(mode="OBJECT")
        if self.others:
            things += [thing for thing in context.selected_objects if thing != things[0]]
        try:
            surfaces = [Surface(context, thing) for thing in things if thing.type in HAS_SURFACE]
            count, found = find(surfaces, self.test, self.distance)
        except nearmiss.NearmissError as error:
            bpy.ops.object.mode_set(mode="EDIT" if mode == "EDIT_MESH" else "OBJECT")
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.tool_settings.mesh_select_mode = (False, False, True)
        bpy.ops.object.mode_set(mode="EDIT")
        lines = [count_of(count, FOUND[self.test]), *select(surfaces, found)]
        context.window_manager.nearmiss.report = "\n".join(lines)
        self.report({"INFO"}, "; ".join(lines))
        return {"FINISHED"}


class VIEW3D_PT_nearmiss(bpy.types.Panel):
    """Options, the operator and its last report, in the sidebar of the 3D view"""

    bl_label = "Crossing Faces"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "nearmiss"

    def draw(self, context):
        layout, settings = self.layout, context.window_manager.nearmiss
        layout.use_property_split = True
        layout.prop(settings, "test")
        if settings.test == "NEAR":
            layout.prop(settings, "distance")
        layout.prop(settings, "others")
        operator = layout.operator(MESH_OT_nearmiss_select.bl_idname, text="Select")
        for name in Options.__annotations__:
            setattr(operator, name, getattr(settings, name))
        for line in settings.report.splitlines():
            layout.label(text=line)


def draw_menu(self, context):
    self.layout.operator(MESH_OT_nearmiss_select.bl_idname)


CLASSES = (Settings, MESH_OT_nearmiss_select, VIEW3D_PT_nearmiss)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.WindowManager.nearmiss = PointerProperty(type=Settings)
    bpy.types.VIEW3D_MT_edit_mesh_select_by_trait.append(draw_menu)


def unregister():
    bpy.types.VIEW3D_MT_edit_mesh_select_by_trait.remove(draw_menu)
    del bpy.types.WindowManager.nearmiss
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
