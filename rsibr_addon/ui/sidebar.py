"""The tab of the viewport's sidebar that holds our panels."""


class InSidebar:
    """Base of the panels in RSIBR's tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "RSIBR"
