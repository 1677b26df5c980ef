"""Reasons why a material depends on more than normal and view, so that no radiance map can hold it."""

from collections.abc import Iterator

import bpy

from .materials import surface_output

SHAPE_OUTPUTS = {
    "ShaderNodeTexCoord": {"Generated", "UV", "Object", "Camera", "Window"},
    "ShaderNodeNewGeometry": {"Position", "Tangent", "Parametric", "Pointiness", "Random Per Island"},
}
"""Type of node -> its outputs that differ between points of equal normal."""

SHAPE_NODES = {
    "ShaderNodeAmbientOcclusion": "it looks at what is near the surface",
    "ShaderNodeAttribute": "it reads an attribute of the object",
    "ShaderNodeBevel": "it looks at what is near the surface",
    "ShaderNodeCameraData": "it depends on the distance to the camera",
    "ShaderNodeHairInfo": "it depends on strands of hair",
    "ShaderNodeObjectInfo": "it depends on the object",
    "ShaderNodeParticleInfo": "it depends on particles",
    "ShaderNodePointInfo": "it depends on points",
    "ShaderNodeRaycast": "it looks at what is near the surface",
    "ShaderNodeScript": "its script may depend on anything",
    "ShaderNodeTangent": "it depends on the tangent",
    "ShaderNodeUVAlongStroke": "it depends on texture coordinates",
    "ShaderNodeUVMap": "it depends on texture coordinates",
    "ShaderNodeVertexColor": "it reads an attribute of the object",
    "ShaderNodeVolumeInfo": "it depends on a volume",
    "ShaderNodeWireframe": "it depends on the mesh",
}
"""Type of node -> the fault of all of its outputs."""

LETS_THROUGH = {
    "ShaderNodeBsdfGlass",
    "ShaderNodeBsdfHair",
    "ShaderNodeBsdfHairPrincipled",
    "ShaderNodeBsdfRayPortal",
    "ShaderNodeBsdfRefraction",
    "ShaderNodeBsdfTranslucent",
    "ShaderNodeBsdfTransparent",
    "ShaderNodeHoldout",
    "ShaderNodeSubsurfaceScattering",
}
"""Types of node whose light passes through the object."""

PASSED_THROUGH = "light passes through the object"
ANISOTROPIC = "its highlights depend on the tangent (anisotropy)"

INERT_VALUES = {
    "Anisotropic": (0.0, ANISOTROPIC),
    "Anisotropy": (0.0, ANISOTROPIC),
    "Alpha": (1.0, PASSED_THROUGH),
    "Subsurface Weight": (0.0, PASSED_THROUGH),
    "Transmission Weight": (0.0, PASSED_THROUGH),
}
"""Input of a BSDF node -> the value at which it does nothing, and the fault of any other value."""


def shape_dependence(material: bpy.types.Material) -> list[str]:
    """Reasons why a radiance map can show a material only as it looks on a sphere.

    A radiance map holds one radiance for each normal and view, so it cannot hold a material that depends on
    the place on a surface, on its tangent, or on things behind it.

    Returns
    -------
    list of str
        Each reason once, as "its highlights depend on the tangent (anisotropy) (node Glossy BSDF)";
        empty for a material that a radiance map can hold.
    """
    output = surface_output(material)
    if output is None:
        return []
    reasons = [
        f"it has a {name.lower()}" for name in ("Volume", "Displacement") if output.inputs[name].is_linked
    ]
    for socket in outputs_behind([output.inputs["Surface"]]):
        reasons += [f"{reason} (node {socket.node.label or socket.node.name})" for reason in _reasons(socket)]
    return list(dict.fromkeys(reasons))


def outputs_behind(inputs: list[bpy.types.NodeSocket]) -> Iterator[bpy.types.NodeSocket]:
    """Every node output that can reach one of `inputs`, also within groups; chains may have any length."""
    waiting, seen = inputs[::-1], set()
    while waiting:
        socket = waiting.pop()
        # Asked for its links, Blender looks through those of the whole tree
        for link in socket.links if socket.is_linked else ():
            socket = link.from_socket
            if link.is_muted or socket.as_pointer() in seen:
                continue
            seen.add(socket.as_pointer())
            yield socket
            of_node = (each for each in socket.node.inputs if not each.is_unavailable)
            waiting += reversed([*_group_inputs(socket), *of_node])


def _group_inputs(socket: bpy.types.NodeSocket) -> list[bpy.types.NodeSocket]:
    """Within a group, the inputs that become its output `socket`."""
    tree = getattr(socket.node, "node_tree", None)
    ends = [node for node in tree.nodes if node.bl_idname == "NodeGroupOutput"] if tree else []
    return [
        each
        for end in ends
        if end.is_active_output
        for each in end.inputs
        if each.identifier == socket.identifier
    ]


def _reasons(socket: bpy.types.NodeSocket) -> Iterator[str]:
    node, kind = socket.node, socket.node.bl_idname
    if node.mute:
        return
    if kind in SHAPE_NODES:
        yield SHAPE_NODES[kind]
    if socket.name in SHAPE_OUTPUTS.get(kind, ()):
        yield f"it depends on the place on the surface ({socket.name})"
    if kind in LETS_THROUGH:
        yield PASSED_THROUGH
    if kind == "ShaderNodeNormalMap" and node.space == "TANGENT":
        yield "it depends on the tangent"
    if kind.startswith("ShaderNodeTex") and _is_placed_by_default(node):
        yield "its texture is placed by default coordinates"
    if kind.startswith("ShaderNodeBsdf"):
        for each in node.inputs:
            inert, reason = INERT_VALUES.get(each.name, (None, ""))
            if reason and (each.is_linked or each.default_value != inert):
                yield reason


def _is_placed_by_default(texture: bpy.types.Node) -> bool:
    vector = texture.inputs.get("Vector")
    return vector is not None and vector.enabled and not vector.is_linked
