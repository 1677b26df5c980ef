"""Plots: well-formed, with every curve where its values are."""

from xml.etree import ElementTree

import numpy as np
from rsibr.rsibr_addon.files.plots import COLORS, Curve, line_plot, polar_picture, polar_plot

SVG = "{http://www.w3.org/2000/svg}"


def lines(plot: str) -> list[np.ndarray]:
    tree = ElementTree.fromstring(plot)
    return [
        np.array([[float(number) for number in point.split(",")] for point in line.get("points", "").split()])
        for line in tree.iter(f"{SVG}polyline")
    ]


def test_curves_lie_where_their_values_are() -> None:
    x = np.array([0.0, 0.5, 1.0])
    curves = [Curve("a < b", x, np.array([0.0, 1.0, 2.0])), Curve("half", x, np.array([1.0, 1.0, 1.0]), True)]
    plot = line_plot("error & more", "n.v", (0.0, 1.0), "E", curves)
    rising, level = lines(plot)
    np.testing.assert_allclose(np.diff(rising, axis=0, n=2), 0.0, atol=0.11)  # tenths of a unit are written
    assert rising[0, 1] > rising[2, 1]  # up is less
    np.testing.assert_allclose(level[:, 1], rising[1, 1], atol=0.11)
    texts = [text.text for text in ElementTree.fromstring(plot).iter(f"{SVG}text")]
    assert {"error & more", "n.v", "E", "a < b", "half"} <= set(texts)


def test_lobes_point_up_along_the_normal_and_right_at_positive_angles() -> None:
    angles = np.array([0.0, 0.5 * np.pi, -0.5 * np.pi, np.pi, 0.0])
    (points,) = lines(polar_plot("lobe", [Curve("lobe", angles, np.array([2.0, 1.0, 1.0, 0.0, -2.0]))]))
    up, right, left, centre, negative = points - points[3]
    np.testing.assert_allclose(centre, 0.0)
    np.testing.assert_allclose(right, -left)
    np.testing.assert_allclose(up, [0.0, -2.0 * right[0]], atol=0.11)
    np.testing.assert_allclose(negative, -up, atol=0.11)


def test_pixels_show_the_lines_of_the_drawing() -> None:
    curve = Curve("lobe", np.radians([0.0, 40.0]), np.array([1.0, 1.0]))
    (points,) = lines(polar_plot("lobe", [curve]))
    pixels = polar_picture([curve])[::-1]
    ink = np.frombuffer(bytes.fromhex(COLORS[0][1:]), np.uint8) / 255.0
    x, y = np.floor(points.mean(axis=0)).astype(int)  # halfway along the straight line between both
    np.testing.assert_allclose(pixels[y, x], ink)
    assert pixels.min() == ink.min()
    assert np.all(pixels[0] == 1.0)
