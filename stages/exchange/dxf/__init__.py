"""DXF: lines that cutters, engravers and CAD programs follow (extra `trimotion[dxf]`)."""
