"""What all triangles are made of: they glow in their own colours, whatever lights there are."""

from pxr import Gf, Sdf, UsdGeom, UsdShade

DARK = {
    "diffuseColor": (Sdf.ValueTypeNames.Color3f, Gf.Vec3f(0)),
    "roughness": (Sdf.ValueTypeNames.Float, 1.0),
    "ior": (Sdf.ValueTypeNames.Float, 1.0),
}
"""By these a surface reflects nothing."""


def add_colors(picture: UsdGeom.Xform) -> None:
    """Make all that lies below a prim shine as `displayColor` says.

    Args:
        picture: The prim.

    Source: Pixar, UsdPreviewSurface Specification.
    """
    stage, path = picture.GetPrim().GetStage(), picture.GetPath().AppendChild("colors")
    material = UsdShade.Material.Define(stage, path)
    surface = UsdShade.Shader.Define(stage, path.AppendChild("surface"))
    surface.CreateIdAttr("UsdPreviewSurface")
    for name, (kind, value) in DARK.items():
        surface.CreateInput(name, kind).Set(value)
    reader = UsdShade.Shader.Define(stage, path.AppendChild("display_color"))
    reader.CreateIdAttr("UsdPrimvarReader_float3")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("displayColor")
    read = reader.CreateOutput("result", Sdf.ValueTypeNames.Float3)
    surface.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(read)
    shown = surface.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(shown)
    UsdShade.MaterialBindingAPI.Apply(picture.GetPrim()).Bind(material)
