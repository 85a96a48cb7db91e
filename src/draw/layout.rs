//! Where circles and labels stand: a layered layout, left to right, by `dagre`.
//!
//! Every arrow is handed over in the direction of the breadth-first order, the
//! way back as well: the graph is then free of cycles, the start alone is in
//! the first layer, and no cycle breaker turns a square into a chain. The two
//! arrows between a pair of states travel as one, so that no third one comes
//! between them.

use std::collections::BTreeMap;

use dagre::graph::{Graph, GraphOptions};
use dagre::layout::types::LabelPos;
use dagre::{EdgeLabel, LayoutOptions, NodeLabel, RankDir};

use super::curve::{LOOP_HEIGHT, Point, RADIUS};
use super::sketch::{Loop, Sketch};

/// The free space around a label, in pixels.
pub(super) const PADDING: f64 = 4.0;

/// The space between a circle and what stands below it, in pixels.
pub(super) const BELOW: f64 = 4.0;

/// The space between the two labels of a bundle, in pixels.
const BETWEEN: f64 = 10.0;

/// The width up to which a label may stand beside another one, in pixels.
const SHORT: f64 = 24.0;

/// The places of a [`Sketch`]'s parts, in pixels, in the same order.
pub(super) struct Plan {
    /// The centres of the circles.
    pub(super) centres: Vec<Point>,
    /// The ways of the arrows.
    pub(super) routes: Vec<Route>,
}

/// The way of an arrow between two circles.
pub(super) struct Route {
    /// The points it goes through, at least one, without the circles.
    pub(super) through: Vec<Point>,
    /// The middle of its label, on the way.
    pub(super) label: Point,
}

/// Finds a place for everything in `sketch`.
pub(super) fn arrange(sketch: &Sketch) -> Plan {
    let bundles = bundles(sketch);
    let mut graph: Graph<NodeLabel, EdgeLabel> = Graph::with_options(GraphOptions {
        directed: true,
        multigraph: true,
        compound: false,
    });
    for (index, state) in sketch.states.iter().enumerate() {
        let mut node = NodeLabel {
            width: 2.0 * RADIUS,
            height: 2.0 * RADIUS,
            ..NodeLabel::default()
        };
        // Room for the loop on top, and as much below, or the other way round:
        // boxes are centred.
        let mut beside: f64 = 0.0;
        if let Some(Loop { label, .. }) = &state.looping {
            node.width = node.width.max(label.width + 2.0 * PADDING);
            beside = LOOP_HEIGHT + label.height();
        }
        if let Some(label) = &state.below {
            node.width = node.width.max(label.width + 2.0 * PADDING);
            beside = beside.max(BELOW + label.height());
        }
        node.height += 2.0 * beside;
        graph.set_node(index.to_string(), Some(node));
    }
    for (index, bundle) in bundles.iter().enumerate() {
        let width = (bundle.arrows.iter())
            .map(|&arrow| sketch.arrows[arrow].label.width)
            .fold(0.0, f64::max);
        let edge = EdgeLabel {
            width: width + 2.0 * PADDING,
            height: bundle_height(sketch, bundle),
            labelpos: LabelPos::Center,
            ..EdgeLabel::default()
        };
        let (low, high) = (bundle.low.to_string(), bundle.high.to_string());
        graph.set_edge(low, high, Some(edge), Some(&index.to_string()));
    }
    let options = LayoutOptions {
        rankdir: RankDir::LR,
        nodesep: 30.0,
        edgesep: 22.0,
        ranksep: 68.0,
        ..LayoutOptions::default()
    };
    dagre::layout(&mut graph, Some(options));

    let mut centres: Vec<Point> = (0..sketch.states.len())
        .map(|index| {
            let node = graph.node(&index.to_string());
            let node = node.expect("the layout keeps every node");
            Point::new(node.x.unwrap_or(0.0), node.y.unwrap_or(0.0))
        })
        .collect();
    let mut ways: Vec<Way> = (bundles.iter().enumerate())
        .map(|(index, bundle)| {
            let (low, high) = (bundle.low.to_string(), bundle.high.to_string());
            let edge = graph.edge(&low, &high, Some(&index.to_string()));
            let edge = edge.expect("the layout keeps every edge");
            let label = Point::new(edge.x.unwrap_or(0.0), edge.y.unwrap_or(0.0));
            // The first and the last point lie on the boxes, not the circles.
            let inner = edge.points.len().saturating_sub(2);
            let mut points: Vec<Point> = (edge.points.iter().skip(1).take(inner))
                .map(|point| Point::new(point.x, point.y))
                .collect();
            if points.is_empty() {
                points.push(label);
            }
            Way { points, label }
        })
        .collect();

    let (across, down) = (stretch(&centres), orientation(&centres));
    let place = |point: &mut Point| *point = Point::new(point.x * across, point.y * down);
    centres.iter_mut().for_each(place);
    for way in &mut ways {
        way.points.iter_mut().for_each(place);
        place(&mut way.label);
    }
    straighten(sketch, &bundles, &centres, &mut ways);
    let mut routes: Vec<Option<Route>> = sketch.arrows.iter().map(|_| None).collect();
    for (bundle, way) in bundles.iter().zip(&ways) {
        let aside = aside(sketch, bundle, centres[bundle.high] - centres[bundle.low]);
        let mut top = -bundle_height(sketch, bundle) / 2.0;
        for &index in &bundle.arrows {
            let arrow = &sketch.arrows[index];
            let height = arrow.label.height() + 2.0 * PADDING;
            let aside = aside * (top + height / 2.0);
            top += height + BETWEEN;
            let mut through: Vec<Point> = way.points.iter().map(|&p| p + aside).collect();
            if arrow.from > arrow.to {
                through.reverse();
            }
            let label = way.label + aside;
            routes[index] = Some(Route { through, label });
        }
    }
    let routes = routes
        .into_iter()
        .map(|route| route.expect("every arrow is in a bundle"));
    Plan {
        centres,
        routes: routes.collect(),
    }
}

/// The arrows between two states, the one to the right above the one back, so
/// that both keep to the left.
struct Bundle {
    low: usize,
    high: usize,
    /// Places in [`Sketch::arrows`], from top to bottom.
    arrows: Vec<usize>,
}

/// The way of a bundle's middle.
struct Way {
    points: Vec<Point>,
    label: Point,
}

fn bundles(sketch: &Sketch) -> Vec<Bundle> {
    let mut by_ends: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (index, arrow) in sketch.arrows.iter().enumerate() {
        let ends = (arrow.from.min(arrow.to), arrow.from.max(arrow.to));
        by_ends.entry(ends).or_default().push(index);
    }
    (by_ends.into_iter())
        .map(|((low, high), mut arrows)| {
            arrows.sort_by_key(|&index| sketch.arrows[index].from > sketch.arrows[index].to);
            Bundle { low, high, arrows }
        })
        .collect()
}

/// The direction in which the arrows of a bundle part: square to the line
/// between the states where its labels are short, otherwise downwards, since
/// wide labels would meet.
fn aside(sketch: &Sketch, bundle: &Bundle, line: Point) -> Point {
    let short = |&index: &usize| {
        let label = &sketch.arrows[index].label;
        label.lines.len() == 1 && label.width <= SHORT
    };
    let length = line.x.hypot(line.y);
    if bundle.arrows.iter().all(short) && length > 0.0 {
        Point::new(-line.y / length, line.x / length)
    } else {
        Point::new(0.0, 1.0)
    }
}

/// The height of a bundle's labels with the space between them, in pixels.
fn bundle_height(sketch: &Sketch, bundle: &Bundle) -> f64 {
    let labels: f64 = (bundle.arrows.iter())
        .map(|&index| sketch.arrows[index].label.height() + 2.0 * PADDING)
        .sum();
    labels + BETWEEN * (bundle.arrows.len() - 1) as f64
}

/// Moves the label of a bundle between neighbouring layers towards the straight
/// line between its circles, as far as it meets nothing on its way.
fn straighten(sketch: &Sketch, bundles: &[Bundle], centres: &[Point], ways: &mut [Way]) {
    let size = |bundle: &Bundle| {
        let widths = bundle.arrows.iter().map(|&i| sketch.arrows[i].label.width);
        let width = widths.fold(0.0, f64::max) + 2.0 * PADDING;
        Point::new(width, bundle_height(sketch, bundle))
    };
    let meet = |a: Point, a_size: Point, b: Point, b_size: Point| {
        2.0 * (a.x - b.x).abs() < a_size.x + b_size.x + BETWEEN
            && 2.0 * (a.y - b.y).abs() < a_size.y + b_size.y + BETWEEN
    };
    for index in 0..ways.len() {
        let [point] = ways[index].points[..] else {
            continue;
        };
        let bundle = &bundles[index];
        let middle = (centres[bundle.low] + centres[bundle.high]) * 0.5;
        let free = |at: Point| {
            let others = ways.iter().zip(bundles).enumerate();
            others
                .filter(|&(other, _)| other != index)
                .all(|(_, (way, other))| !meet(at, size(bundle), way.label, size(other)))
        };
        let step = |quarters: f64| point + (middle - point) * (quarters / 4.0);
        if let Some(at) = [4.0, 3.0, 2.0, 1.0]
            .map(step)
            .into_iter()
            .find(|&at| free(at))
        {
            ways[index].points[0] = at;
            ways[index].label = at;
        }
    }
}

/// By how much to widen a picture that is high for its width, where arrows
/// would be steep.
fn stretch(centres: &[Point]) -> f64 {
    let span = |values: Vec<f64>| {
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        high - values.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let width = span(centres.iter().map(|centre| centre.x).collect());
    let height = span(centres.iter().map(|centre| centre.y).collect());
    if width <= 0.0 {
        return 1.0;
    }
    (1.8 * height / width).clamp(1.0, 1.5)
}

/// `-1` where the picture reads better upside down, with the states of a layer
/// in their order from the top, otherwise `1`.
fn orientation(centres: &[Point]) -> f64 {
    let mut order = 0;
    for (index, upper) in centres.iter().enumerate() {
        for lower in &centres[index + 1..] {
            if (upper.x - lower.x).abs() < 1.0 {
                order += if upper.y < lower.y { 1 } else { -1 };
            }
        }
    }
    if order < 0 { -1.0 } else { 1.0 }
}
