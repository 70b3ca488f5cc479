//! ezpz as a peer of the solver benchmark. Each line on standard input is the path of a sketch; each answer is
//! a line of JSON on standard output, in the form of `worker.py`.

use std::io::{self, BufRead, Write};
use std::time::{Duration, Instant};

use ezpz::datatypes::inputs::{
    DatumCircle, DatumCircularArc, DatumDistance, DatumLineSegment, DatumPoint,
};
use ezpz::datatypes::{Angle, AngleKind};
use ezpz::{CircleSide, Config, Constraint, ConstraintRequest, Id, IdGenerator, LineSide, solve};
use serde_json::{Value, json};

/// For how long a quick sketch is solved again and again.
const TURN: Duration = Duration::from_millis(50);

/// A sketch as ezpz sees it. The ids of unknowns come in the order of the format: points, then radii.
struct Model {
    start: Vec<[f64; 2]>,
    ends: Vec<[usize; 2]>,
    points: Vec<DatumPoint>,
    lines: Vec<DatumLineSegment>,
    circles: Vec<DatumCircle>,
    arcs: Vec<DatumCircularArc>,
    guesses: Vec<(Id, f64)>,
    requests: Vec<ConstraintRequest>,
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}

fn list<'a>(sketch: &'a Value, name: &str) -> &'a [Value] {
    sketch[name].as_array().map_or(&[], Vec::as_slice)
}

fn segment(a: DatumPoint, b: DatumPoint) -> DatumLineSegment {
    DatumLineSegment::new(a, b)
}

impl Model {
    fn new(sketch: &Value) -> Result<Self, String> {
        let mut model = Self::geometry(sketch);
        let mut stated: Vec<Constraint> = model.arcs.iter().map(|arc| Constraint::Arc(*arc)).collect();
        for constraint in list(sketch, "constraints") {
            model.state(constraint, &mut stated)?;
        }
        model.requests = stated.into_iter().map(ConstraintRequest::highest_priority).collect();
        Ok(model)
    }

    fn geometry(sketch: &Value) -> Self {
        let mut ids = IdGenerator::default();
        let start: Vec<[f64; 2]> =
            list(sketch, "points").iter().map(|p| [number(&p[0]), number(&p[1])]).collect();
        let points: Vec<DatumPoint> = start.iter().map(|_| DatumPoint::new(&mut ids)).collect();
        let mut guesses: Vec<(Id, f64)> = points
            .iter()
            .zip(&start)
            .flat_map(|(p, at)| [(p.id_x(), at[0]), (p.id_y(), at[1])])
            .collect();
        let ends: Vec<[usize; 2]> =
            list(sketch, "lines").iter().map(|l| [index(&l[0]), index(&l[1])]).collect();
        let lines = ends.iter().map(|[a, b]| segment(points[*a], points[*b])).collect();
        let mut circles = Vec::new();
        for circle in list(sketch, "circles") {
            let radius = DatumDistance::new(ids.next_id());
            guesses.push((radius.id, number(&circle[1])));
            circles.push(DatumCircle { center: points[index(&circle[0])], radius });
        }
        let arcs = list(sketch, "arcs")
            .iter()
            .map(|arc| DatumCircularArc {
                center: points[index(&arc[0])],
                start: points[index(&arc[1])],
                end: points[index(&arc[2])],
            })
            .collect();
        Self { start, ends, points, lines, circles, arcs, guesses, requests: Vec::new() }
    }

    /// Twice the area between a line and a point at the first guesses: positive on the left.
    fn side(&self, line: usize, point: usize) -> f64 {
        let [a, b] = self.ends[line].map(|end| self.start[end]);
        let p = self.start[point];
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    }

    /// Positive if the second line turns left of the first at the first guesses.
    fn turn(&self, first: usize, second: usize) -> f64 {
        let [u, v] = [first, second].map(|line| {
            let [a, b] = self.ends[line].map(|end| self.start[end]);
            [b[0] - a[0], b[1] - a[1]]
        });
        u[0] * v[1] - u[1] * v[0]
    }

    /// The centre of a curve and a point on it, if it is an arc, or else its radius.
    fn curve(&self, curve: &Value) -> (DatumPoint, Result<DatumDistance, DatumPoint>) {
        let i = index(&curve[1]);
        if curve[0] == "c" {
            (self.circles[i].center, Ok(self.circles[i].radius))
        } else {
            (self.arcs[i].center, Err(self.arcs[i].start))
        }
    }

    fn circle(&self, curve: &Value) -> Option<DatumCircle> {
        (curve[0] == "c").then(|| self.circles[index(&curve[1])])
    }

    fn state(&self, c: &Value, stated: &mut Vec<Constraint>) -> Result<(), String> {
        let point = |name: &str| self.points[index(&c[name])];
        let line = |name: &str| self.lines[index(&c[name])];
        let arc = |name: &str| self.arcs[index(&c[name])];
        let spoke = |name: &str, end: &str| {
            let arc = self.arcs[index(&c[name])];
            segment(arc.center, if c[end] == 1 { arc.end } else { arc.start })
        };
        let v = c["v"].as_f64().unwrap_or_default();
        let kind = c["t"].as_str().unwrap_or_default();
        let mut fixed = None;
        stated.push(match kind {
            "fixed" => {
                fixed = Some(Constraint::Fixed(point("p").id_y(), number(&c["y"])));
                Constraint::Fixed(point("p").id_x(), number(&c["x"]))
            }
            "fix_x" => Constraint::Fixed(point("p").id_x(), v),
            "fix_y" => Constraint::Fixed(point("p").id_y(), v),
            "coincident" => Constraint::PointsCoincident(point("a"), point("b")),
            "horizontal" => Constraint::Horizontal(segment(point("a"), point("b"))),
            "vertical" => Constraint::Vertical(segment(point("a"), point("b"))),
            "hdist" => Constraint::HorizontalDistance(point("b"), point("a"), v),
            "vdist" => Constraint::VerticalDistance(point("b"), point("a"), v),
            "distance" => Constraint::Distance(point("a"), point("b"), v),
            "parallel" => Constraint::lines_parallel([line("l"), line("m")]),
            "perpendicular" => Constraint::lines_perpendicular([line("l"), line("m")]),
            "equal_length" => Constraint::LinesEqualLength(line("l"), line("m")),
            "midpoint" => Constraint::Midpoint(line("l"), point("p")),
            "symmetric" => Constraint::Symmetric(line("l"), point("a"), point("b")),
            "arc_length" => Constraint::ArcLength(arc("arc"), v),
            "point_on_line" => Constraint::PointLineDistance(point("p"), line("l"), 0.0),
            "point_line_distance" => {
                let is_left = c["signed"] == true || self.side(index(&c["l"]), index(&c["p"])) >= 0.0;
                Constraint::PointLineDistance(point("p"), line("l"), if is_left { v } else { -v })
            }
            "angle" => {
                let is_right =
                    c["mode"] == "cos" && self.turn(index(&c["l"]), index(&c["m"])) < 0.0;
                let angle = Angle::from_degrees(if is_right { -v } else { v });
                Constraint::LinesAtAngle(line("l"), line("m"), AngleKind::Other(angle))
            }
            "tangent_at_end" => Constraint::lines_perpendicular([line("l"), spoke("arc", "end")]),
            "tangent_arcs_at_ends" => {
                Constraint::lines_parallel([spoke("arc", "end"), spoke("arc2", "end2")])
            }
            "radius" => match self.curve(&c["k"]) {
                (_, Ok(radius)) => Constraint::Fixed(radius.id, v),
                (centre, Err(start)) => Constraint::Distance(centre, start, v),
            },
            "equal_radius" => match (self.curve(&c["k"]), self.curve(&c["k2"])) {
                ((_, Ok(r)), (_, Ok(s))) => Constraint::ScalarEqual(r.id, s.id),
                ((_, Ok(r)), (centre, Err(start))) | ((centre, Err(start)), (_, Ok(r))) => {
                    Constraint::DistanceVar(centre, start, r)
                }
                ((a, Err(b)), (d, Err(e))) => Constraint::LinesEqualLength(segment(a, b), segment(d, e)),
            },
            "point_on_circle" => match self.curve(&c["k"]) {
                (centre, Ok(radius)) => Constraint::DistanceVar(point("p"), centre, radius),
                (_, Err(_)) => Constraint::PointArcCoincident(self.arcs[index(&c["k"][1])], point("p")),
            },
            "tangent_line" => {
                let circle = self.circle(&c["k"]).ok_or("tangent_line of an arc")?;
                Constraint::LineTangentToCircle(line("l"), circle, LineSide::Undefined)
            }
            "tangent_curves" => {
                let pair = self.circle(&c["k"]).zip(self.circle(&c["k2"]));
                let (first, second) = pair.ok_or("tangent_curves of arcs")?;
                let side = if c["internal"] == true { CircleSide::Interior } else { CircleSide::Exterior };
                Constraint::CircleTangentToCircle(first, second, side)
            }
            _ => return Err(kind.to_owned()),
        });
        stated.extend(fixed);
        Ok(())
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

/// What came of one sketch; a quick one is solved over and over, as in `worker.py`.
fn answer(path: &str) -> Value {
    let sketch = std::fs::read_to_string(path)
        .map_err(|error| error.to_string())
        .and_then(|text| serde_json::from_str(&text).map_err(|error| error.to_string()));
    let sketch: Value = match sketch {
        Ok(sketch) => sketch,
        Err(error) => return json!({"failed": format!("{path}: {error}")}),
    };
    let (mut build, mut solving) = (Vec::new(), Vec::new());
    let turn = Instant::now();
    loop {
        let start = Instant::now();
        let model = match Model::new(&sketch) {
            Ok(model) => model,
            Err(kind) => return json!({"unsupported": kind}),
        };
        build.push(start.elapsed().as_secs_f64());
        let guesses = model.guesses.clone();
        let start = Instant::now();
        let outcome = solve(&model.requests, guesses, Config::default());
        solving.push(start.elapsed().as_secs_f64());
        if turn.elapsed() < TURN {
            continue;
        }
        if solving.len() > 1 {
            build.remove(0);
            solving.remove(0);
        }
        let (said, x) = match &outcome {
            Ok(found) if found.is_satisfied() => ("satisfied".to_owned(), found.final_values().to_vec()),
            Ok(found) => ("unsatisfied".to_owned(), found.final_values().to_vec()),
            Err(failure) => {
                (failure.error().to_string(), model.guesses.iter().map(|(_, guess)| *guess).collect())
            }
        };
        return json!({"build": median(build), "solve": median(solving), "said": said, "x": x});
    }
}

fn main() -> io::Result<()> {
    let mut output = io::stdout().lock();
    writeln!(output, "{}", json!({"version": "0.2.29"}))?;
    for path in io::stdin().lock().lines() {
        writeln!(output, "{}", answer(&path?))?;
        output.flush()?;
    }
    Ok(())
}
