//! The markup of a picture.

use std::fmt::Write;

use super::curve::{Curve, HEAD, LOOP_HEIGHT, Point, RADIUS};
use super::layout::{BELOW, PADDING, Plan};
use super::marks::Mark;
use super::ports::ports;
use super::sketch::{Loop, Sketch};
use super::text::{FONT_SIZE, LINE_HEIGHT, Label, escape, number, width};

/// Said where the rejecting sink is left out.
pub(super) const NOTE: &str = "Anything else fails.";

/// The distance of the inner ring of an accepting state from the outer one.
const RING: f64 = 4.5;

/// The space around everything, in pixels.
const MARGIN: f64 = 10.0;

/// For what the markup is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// An element of a page.
    Element,
    /// A file of its own.
    Document,
}

/// The label of an arrow with the middle of its place.
struct Placed<'a> {
    label: &'a Label,
    middle: Point,
}

/// An arrow's line, its ends in the sketch, and its label.
struct Line<'a> {
    curve: Curve,
    from: usize,
    to: usize,
    text: Placed<'a>,
    marks: &'a [Mark],
}

/// Writes the picture of `sketch` at the places of `plan`.
pub(super) fn markup(sketch: &Sketch, plan: &Plan, form: Form) -> String {
    let lines = lines(sketch, plan);
    let entering = Curve::entering(plan.centres[0]);
    let below = below(sketch, plan);
    let (low, mut high) = bounds(plan, &lines, &below, &entering);
    let note_at = Point::new(low.x, high.y + LINE_HEIGHT);
    if sketch.hides_sink {
        high.y = note_at.y + 0.35 * FONT_SIZE;
        high.x = high.x.max(low.x + width(NOTE));
    }
    let frame = Frame {
        x: low.x - MARGIN,
        y: low.y - MARGIN,
        width: high.x - low.x + 2.0 * MARGIN,
        height: high.y - low.y + 2.0 * MARGIN,
    };

    let id = format!("automaton-{:08x}", digest(&sketch.description));
    let mut out = String::new();
    open(&mut out, sketch, &frame, &id, form);
    mask(&mut out, &lines, &below, &frame, &id);
    out.push_str("<g mask=\"url(#");
    out.push_str(&id);
    out.push_str("-labels)\" fill=\"none\">\n");
    out.push_str("<g class=\"start\">");
    arrow(&mut out, &entering);
    out.push_str("</g>\n");
    for line in &lines {
        let (from, to) = (
            sketch.states[line.from].number,
            sketch.states[line.to].number,
        );
        let class = classes("arrow", line.marks);
        put(
            &mut out,
            format_args!("<g class=\"{class}\" data-from=\"{from}\" data-to=\"{to}\""),
        );
        weight(&mut out, line.marks);
        arrow(&mut out, &line.curve);
        out.push_str("</g>\n");
    }
    out.push_str("</g>\n");
    for (state, &centre) in sketch.states.iter().zip(&plan.centres) {
        let class = if state.accepting {
            "state accepting"
        } else {
            "state"
        };
        let class = classes(class, &state.marks);
        put(
            &mut out,
            format_args!("<g class=\"{class}\" data-state=\"{}\"", state.number),
        );
        weight(&mut out, &state.marks);
        ring(&mut out, centre, RADIUS);
        if state.accepting {
            ring(&mut out, centre, RADIUS - RING);
        }
        text(&mut out, centre, "middle", &state.number.to_string());
        out.push_str("</g>\n");
    }
    out.push_str("<g class=\"label\" text-anchor=\"middle\">\n");
    for line in &lines {
        words(&mut out, &line.text);
    }
    out.push_str("</g>\n");
    if !below.is_empty() {
        out.push_str("<g class=\"phrase\" font-size=\"13.5\">\n");
        for placed in &below {
            words(&mut out, placed);
        }
        out.push_str("</g>\n");
    }
    if sketch.hides_sink {
        out.push_str("<g class=\"note\" opacity=\"0.75\">");
        text(&mut out, note_at, "start", NOTE);
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

/// The part of the plane that is shown.
struct Frame {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

/// All arrows with their labels, loops after the others.
fn lines<'a>(sketch: &'a Sketch, plan: &Plan) -> Vec<Line<'a>> {
    let mut lines = Vec::new();
    let ports = ports(sketch, plan);
    for ((arrow, route), ports) in sketch.arrows.iter().zip(&plan.routes).zip(ports) {
        lines.push(Line {
            curve: Curve::between(
                plan.centres[arrow.from],
                &route.through,
                plan.centres[arrow.to],
                ports,
            ),
            from: arrow.from,
            to: arrow.to,
            text: Placed {
                label: &arrow.label,
                middle: route.label,
            },
            marks: &arrow.marks,
        });
    }
    for (index, (state, &centre)) in sketch.states.iter().zip(&plan.centres).enumerate() {
        if let Some(Loop { label, marks }) = &state.looping {
            let rise = RADIUS + LOOP_HEIGHT + label.height() / 2.0;
            lines.push(Line {
                curve: Curve::looping(centre),
                from: index,
                to: index,
                text: Placed {
                    label,
                    middle: centre - Point::new(0.0, rise),
                },
                marks,
            });
        }
    }
    lines
}

/// What stands below circles.
fn below<'a>(sketch: &'a Sketch, plan: &Plan) -> Vec<Placed<'a>> {
    let placed = (sketch.states.iter().zip(&plan.centres)).filter_map(|(state, &centre)| {
        let label = state.below.as_ref()?;
        let fall = RADIUS + BELOW + label.height() / 2.0;
        let middle = centre + Point::new(0.0, fall);
        Some(Placed { label, middle })
    });
    placed.collect()
}

/// A class, and those of the marks.
fn classes(class: &str, marks: &[Mark]) -> String {
    let marks = marks.iter().map(|mark| mark.class());
    let classes: Vec<&str> = [class].into_iter().chain(marks).collect();
    classes.join(" ")
}

/// Ends the tag of something marked: thicker where it is new, dashed where it is
/// in dispute; the colour is the page's.
fn weight(out: &mut String, marks: &[Mark]) {
    if marks.contains(&Mark::New) {
        out.push_str(" stroke-width=\"2.75\"");
    }
    if marks.contains(&Mark::Disputed) {
        out.push_str(" stroke-dasharray=\"7 5\"");
    }
    out.push('>');
}

/// The corners of the smallest box around everything that is drawn.
fn bounds(
    plan: &Plan,
    lines: &[Line<'_>],
    below: &[Placed<'_>],
    entering: &Curve,
) -> (Point, Point) {
    let mut low = Point::new(f64::INFINITY, f64::INFINITY);
    let mut high = Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY);
    let mut cover = |point: Point, x: f64, y: f64| {
        low = Point::new(low.x.min(point.x - x), low.y.min(point.y - y));
        high = Point::new(high.x.max(point.x + x), high.y.max(point.y + y));
    };
    cover(entering.start, 0.0, 0.0);
    for &centre in &plan.centres {
        cover(centre, RADIUS, RADIUS);
    }
    for Placed { label, middle } in below {
        cover(*middle, label.width / 2.0, label.height() / 2.0);
    }
    for line in lines {
        let label = line.text.label;
        cover(line.text.middle, label.width / 2.0, label.height() / 2.0);
        if line.from != line.to {
            // A curve stays within the hull of its control points.
            for piece in &line.curve.pieces {
                cover(piece.first, 0.0, 0.0);
                cover(piece.second, 0.0, 0.0);
            }
        }
    }
    (low, high)
}

/// The element's beginning with what readers of screens are told.
fn open(out: &mut String, sketch: &Sketch, frame: &Frame, id: &str, form: Form) {
    if form == Form::Document {
        out.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    }
    out.push_str("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"automaton\" role=\"img\" ");
    put(
        out,
        format_args!("aria-labelledby=\"{id}-title {id}-desc\" width=\""),
    );
    number(out, frame.width);
    out.push_str("\" height=\"");
    number(out, frame.height);
    out.push_str("\" viewBox=\"");
    numbers(out, &[frame.x, frame.y, frame.width, frame.height]);
    out.push_str("\" stroke=\"currentColor\" stroke-width=\"1.75\" stroke-linecap=\"round\" ");
    out.push_str("font-family=\"system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif\" ");
    put(out, format_args!("font-size=\"{FONT_SIZE}\""));
    if form == Form::Document {
        out.push_str(" color=\"#1c1e21\"");
    }
    put(out, format_args!(">\n<title id=\"{id}-title\">"));
    escape(out, &sketch.title);
    put(out, format_args!("</title>\n<desc id=\"{id}-desc\">"));
    escape(out, &sketch.description);
    out.push_str("</desc>\n");
    if form == Form::Document {
        // Readers without style sheets see the attributes: dark ink on white.
        out.push_str(
            "<style>@media (prefers-color-scheme: dark) { \
             .automaton { color: #e6e7e9 } .paper { fill: #1b1d21 } }</style>\n",
        );
        out.push_str("<rect class=\"paper\" stroke=\"none\" fill=\"#ffffff\" ");
        rectangle(out, frame.x, frame.y, frame.width, frame.height);
    }
}

/// Cuts the lines under the labels away: a label then stands on the ground of
/// whatever page the picture is in, light or dark.
fn mask(out: &mut String, lines: &[Line<'_>], below: &[Placed<'_>], frame: &Frame, id: &str) {
    put(
        out,
        format_args!("<mask id=\"{id}-labels\" maskUnits=\"userSpaceOnUse\" "),
    );
    let place = |out: &mut String| {
        for (name, value) in [
            ("x", frame.x),
            ("y", frame.y),
            ("width", frame.width),
            ("height", frame.height),
        ] {
            put(out, format_args!("{name}=\""));
            number(out, value);
            out.push_str("\" ");
        }
    };
    place(out);
    out.push_str("stroke=\"none\">\n<rect fill=\"#ffffff\" ");
    rectangle(out, frame.x, frame.y, frame.width, frame.height);
    for line in lines {
        let Placed { label, middle } = &line.text;
        // A loop's label stands above the loop, which is not to be cut.
        let (x, y) = if line.from == line.to {
            (label.width, label.height() - 4.0)
        } else {
            (label.width + 2.0 * PADDING, label.height())
        };
        out.push_str("<rect fill=\"#000000\" rx=\"4\" ");
        rectangle(out, middle.x - x / 2.0, middle.y - y / 2.0, x, y);
    }
    for Placed { label, middle } in below {
        out.push_str("<rect fill=\"#000000\" rx=\"4\" ");
        let (x, y) = (label.width, label.height());
        rectangle(out, middle.x - x / 2.0, middle.y - y / 2.0, x, y);
    }
    out.push_str("</mask>\n");
}

/// Writes the rest of a `<rect>`.
fn rectangle(out: &mut String, x: f64, y: f64, width: f64, height: f64) {
    out.push_str("x=\"");
    number(out, x);
    out.push_str("\" y=\"");
    number(out, y);
    out.push_str("\" width=\"");
    number(out, width);
    out.push_str("\" height=\"");
    number(out, height);
    out.push_str("\"/>\n");
}

/// A line and its head.
fn arrow(out: &mut String, curve: &Curve) {
    out.push_str("<path d=\"M");
    numbers(out, &[curve.start.x, curve.start.y]);
    for piece in &curve.pieces {
        out.push_str(" C");
        let Point { x, y } = piece.first;
        numbers(
            out,
            &[
                x,
                y,
                piece.second.x,
                piece.second.y,
                piece.end.x,
                piece.end.y,
            ],
        );
    }
    let across = Point::new(-curve.heading.y, curve.heading.x) * (HEAD * 0.45);
    let foot = curve.tip - curve.heading * HEAD;
    out.push_str("\"/><path fill=\"currentColor\" stroke=\"none\" d=\"M");
    numbers(out, &[curve.tip.x, curve.tip.y]);
    for corner in [foot + across, foot - across] {
        out.push_str(" L");
        numbers(out, &[corner.x, corner.y]);
    }
    out.push_str(" Z\"/>");
}

/// A ring.
fn ring(out: &mut String, centre: Point, radius: f64) {
    out.push_str("<circle fill=\"none\" cx=\"");
    number(out, centre.x);
    out.push_str("\" cy=\"");
    number(out, centre.y);
    out.push_str("\" r=\"");
    number(out, radius);
    out.push_str("\"/>");
}

/// The lines of a label around its middle.
fn words(out: &mut String, placed: &Placed<'_>) {
    let first = placed.middle.y - (placed.label.height() - LINE_HEIGHT) / 2.0;
    for (index, line) in placed.label.lines.iter().enumerate() {
        let y = first + LINE_HEIGHT * index as f64;
        text(out, Point::new(placed.middle.x, y), "middle", line);
    }
    out.push('\n');
}

/// One line of text; its middle height is at `at`.
fn text(out: &mut String, at: Point, anchor: &str, content: &str) {
    // A third of the size below the middle is the base line; the attribute
    // that says so is not known to every viewer.
    put(
        out,
        format_args!("<text stroke=\"none\" fill=\"currentColor\" text-anchor=\"{anchor}\" x=\""),
    );
    number(out, at.x);
    out.push_str("\" y=\"");
    number(out, at.y + 0.35 * FONT_SIZE);
    out.push_str("\">");
    escape(out, content);
    out.push_str("</text>");
}

/// Coordinates with spaces between them.
fn numbers(out: &mut String, values: &[f64]) {
    for (index, &value) in values.iter().enumerate() {
        if index > 0 {
            out.push(' ');
        }
        number(out, value);
    }
}

fn put(out: &mut String, arguments: std::fmt::Arguments<'_>) {
    out.write_fmt(arguments)
        .expect("writing to a string cannot fail");
}

/// A short name for a picture (FNV-1a), so that two of them in one page do not
/// share their masks.
fn digest(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}
