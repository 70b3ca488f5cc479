"""STEP (AP214): solids of those bodies that have a thickness, plane faces of the others, and the strokes.

Every body is a product of its own in an assembly named after the root. The file is written here because a
drawing has so few kinds of solids: what Open CASCADE writes of a plate with n edges takes it a time that
grows with n² (six minutes for ten thousand holes), and it is a large thing to install.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PIL import ImageColor

from aidl_lang.export import Exported, Job
from aidl_lang.export.brep import Entities, Shapes, listed, real, text
from aidl_lang.export.solids import placed_bodies, placed_strokes
from aidl_lang.geometry.drawing import Style
from aidl_lang.geometry.placement import placement_notes
from aidl_lang.version import __version__

_SCHEMA = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
_NO_TIME = "1970-01-01T00:00:00"
"""Readers want a time; the same drawing is to be the same file at any."""
_ACCURACY = 1e-9
"""How well ends meet, relative to the size of the drawing."""


@dataclass(frozen=True)
class _Part:
    """A product: its name, what represents it, and how it looks."""

    name: str
    items: Sequence[str]
    kind: str
    style: Style


@dataclass(frozen=True)
class _Product:
    """The entities of a product that others refer to."""

    definition: str
    shape: str
    axes: str


def to_step(job: Job) -> Exported:
    """The STEP file. Raises ExportError (E0918) for a body that cannot be placed or made solid."""
    entities = Entities()
    parts = [*_bodies(job, entities), *_strokes(job, entities)]
    file = _File(entities, max(1e-7, _ACCURACY * job.drawing.size))
    root = job.model.root.path
    if [part.name for part in parts] == [root]:
        file.product(parts[0])
    else:
        file.assembly(root, parts)
    file.looks(parts)
    header = (
        f"FILE_DESCRIPTION(({text('drawing')}),'2;1');\n"
        f"FILE_NAME({text(root)},'{_NO_TIME}',(''),(''),{text(f'AIDL {__version__}')},'AIDL','');\n"
        f"FILE_SCHEMA(('{_SCHEMA}'));\n"
    )
    data = "\n".join(entities.lines)
    content = f"ISO-10303-21;\nHEADER;\n{header}ENDSEC;\nDATA;\n{data}\nENDSEC;\nEND-ISO-10303-21;\n"
    return Exported(content.encode("ascii"), notes=tuple(placement_notes(job.model.root, job.drawing)))


def _bodies(job: Job, entities: Entities) -> list[_Part]:
    parts = []
    for placed in placed_bodies(job):
        body = placed.body
        if placed.thickness is None:
            items = [Shapes(entities, placed.plane).sheet(body.region.faces, body.path)]
            kind = "MANIFOLD_SURFACE_SHAPE_REPRESENTATION"
        else:
            shapes = Shapes(entities, placed.plane, placed.thickness)
            items = [shapes.solid(face, body.path) for face in body.region.faces]
            kind = "ADVANCED_BREP_SHAPE_REPRESENTATION"
        parts.append(_Part(body.path, items, kind, body.style))
    return parts


def _strokes(job: Job, entities: Entities) -> list[_Part]:
    kind = "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"
    return [
        _Part(
            stroke.geometry,
            [Shapes(entities, plane).curves(stroke.pieces, stroke.geometry)],
            kind,
            stroke.style,
        )
        for stroke, plane in placed_strokes(job)
    ]


class _File:
    """Products, their assembly, and their looks (ISO 10303-41, -43, -44 and -46)."""

    def __init__(self, entities: Entities, accuracy: float) -> None:
        self.add = add = entities.add
        self.origin = entities.point((0.0, 0.0, 0.0))
        self.up, self.right = entities.direction((0.0, 0.0, 1.0)), entities.direction((1.0, 0.0, 0.0))
        self.application = add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')")
        standard = "'international standard','automotive_design',2000"
        add(f"APPLICATION_PROTOCOL_DEFINITION({standard},{self.application})")
        self.products = add(f"PRODUCT_CONTEXT('',{self.application},'mechanical')")
        self.definitions = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{self.application},'design')")
        length = add("( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) )")
        angle = add("( NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.) )")
        solid_angle = add("( NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT() )")
        uncertainty = add(
            f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({real(accuracy)}),{length},"
            "'distance_accuracy_value','confusion accuracy')"
        )
        self.space = add(
            "( GEOMETRIC_REPRESENTATION_CONTEXT(3) "
            f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({uncertainty})) "
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle})) "
            "REPRESENTATION_CONTEXT('','3D') )"
        )

    def product(self, part: _Part, *places: str) -> _Product:
        """A product with its representation; `places` are axes beside its own."""
        add, name = self.add, text(part.name)
        product = add(f"PRODUCT({name},{name},{text(part.style.material or '')},({self.products}))")
        add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,({product}))")
        formation = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        definition = add(f"PRODUCT_DEFINITION('design','',{formation},{self.definitions})")
        shape = add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        axes = self._axes()
        representation = add(f"{part.kind}({name},{listed((axes, *places, *part.items))},{self.space})")
        add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{representation})")
        return _Product(definition, representation, axes)

    def assembly(self, name: str, parts: Sequence[_Part]) -> None:
        add = self.add
        places = [self._axes() for _ in parts]
        whole = self.product(_Part(name, (), "SHAPE_REPRESENTATION", Style()), *places)
        for number, (part, place) in enumerate(zip(parts, places, strict=True), 1):
            made = self.product(part)
            move = add(f"ITEM_DEFINED_TRANSFORMATION('','',{made.axes},{place})")
            relation = add(
                f"( REPRESENTATION_RELATIONSHIP('','',{made.shape},{whole.shape}) "
                f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({move}) "
                "SHAPE_REPRESENTATION_RELATIONSHIP() )"
            )
            use = add(
                f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number}',{text(part.name)},'',"
                f"{whole.definition},{made.definition},$)"
            )
            placement = add(f"PRODUCT_DEFINITION_SHAPE('Placement','Placement of an item',{use})")
            add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{placement})")

    def _axes(self) -> str:
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.origin},{self.up},{self.right})")

    def looks(self, parts: Sequence[_Part]) -> None:
        """Colours and layers."""
        add = self.add
        styled = [
            add(f"STYLED_ITEM('color',({self._style(part)}),{item})")
            for part in parts
            if part.style.color is not None
            for item in part.items
        ]
        if styled:
            add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{listed(styled)},{self.space})")
        for layer in dict.fromkeys(part.style.layer for part in parts if part.style.layer is not None):
            items = [item for part in parts if part.style.layer == layer for item in part.items]
            add(f"PRESENTATION_LAYER_ASSIGNMENT({text(layer)},'',{listed(items)})")

    def _style(self, part: _Part) -> str:
        add = self.add
        assert part.style.color is not None
        red, green, blue = (real(value / 255) for value in ImageColor.getrgb(part.style.color)[:3])
        color = add(f"COLOUR_RGB('',{red},{green},{blue})")
        if part.kind.startswith("GEOMETRICALLY"):
            font = add("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')")
            style = add(f"CURVE_STYLE('',{font},POSITIVE_LENGTH_MEASURE(0.1),{color})")
        else:
            paint = add(f"FILL_AREA_STYLE_COLOUR('',{color})")
            fill = add(f"FILL_AREA_STYLE('',({paint}))")
            side = add(f"SURFACE_SIDE_STYLE('',({add(f'SURFACE_STYLE_FILL_AREA({fill})')}))")
            style = add(f"SURFACE_STYLE_USAGE(.BOTH.,{side})")
        return add(f"PRESENTATION_STYLE_ASSIGNMENT(({style}))")
