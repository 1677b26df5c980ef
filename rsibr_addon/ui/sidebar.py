"""The tab of the viewport's sidebar that holds our panels."""


class InSidebar:
    """Of panels in our tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "RSIBR"
