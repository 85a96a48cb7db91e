//! Where circles and labels stand: a layered layout, left to right, by `dagre`.
//!
//! Every arrow is handed over in the direction of the breadth-first order, the
//! way back as well: the graph is then free of cycles, the start alone is in
//! the first layer, and no cycle breaker turns a square into a chain. The ways
//! there and back between two states are one edge to `dagre`, with room for
//! both: they then run side by side and never cross each other.

use std::collections::BTreeMap;

use dagre::graph::{Graph, GraphOptions};
use dagre::{EdgeLabel, LayoutOptions, NodeLabel, RankDir};

use super::curve::{LOOP_HEIGHT, Point, RADIUS};
use super::sketch::{Arrow, Sketch};

/// The free space around a label, in pixels.
pub(super) const PADDING: f64 = 4.0;

/// The free space between the labels of a way there and the way back, in pixels.
const BETWEEN: f64 = 12.0;

/// How far from each other's line they meet the circles, halved, in pixels.
const ASIDE: f64 = 7.0;

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
    /// How far below the centres of its circles it aims, in pixels.
    pub(super) aside: f64,
}

/// Finds a place for everything in `sketch`.
pub(super) fn arrange(sketch: &Sketch) -> Plan {
    let mut graph: Graph<NodeLabel, EdgeLabel> = Graph::with_options(GraphOptions {
        directed: true,
        multigraph: false,
        compound: false,
    });
    for (index, state) in sketch.states.iter().enumerate() {
        let mut node = NodeLabel {
            width: 2.0 * RADIUS,
            height: 2.0 * RADIUS,
            ..NodeLabel::default()
        };
        if let Some(label) = &state.looping {
            // Room for the loop on top, and as much below: boxes are centred.
            node.width = node.width.max(label.width + 2.0 * PADDING);
            node.height += 2.0 * (LOOP_HEIGHT + label.height());
        }
        graph.set_node(index.to_string(), Some(node));
    }
    let lanes = lanes(sketch);
    for (&(low, high), lane) in &lanes {
        let edge = EdgeLabel {
            width: lane.width + 2.0 * PADDING,
            height: lane.height + 2.0 * PADDING,
            labelpos: dagre::layout::types::LabelPos::Center,
            ..EdgeLabel::default()
        };
        graph.set_edge(low.to_string(), high.to_string(), Some(edge), None);
    }
    let options = LayoutOptions {
        rankdir: RankDir::LR,
        nodesep: 30.0,
        edgesep: 22.0,
        ranksep: 68.0,
        ..LayoutOptions::default()
    };
    dagre::layout(&mut graph, Some(options));

    let centres = (0..sketch.states.len())
        .map(|index| {
            let node = graph.node(&index.to_string());
            let node = node.expect("the layout keeps every node");
            Point::new(node.x.unwrap_or(0.0), node.y.unwrap_or(0.0))
        })
        .collect();
    let routes = (sketch.arrows.iter())
        .map(|arrow| {
            let (low, high) = ends(arrow);
            let edge = graph.edge(&low.to_string(), &high.to_string(), None);
            let edge = edge.expect("the layout keeps every edge");
            let shift = lanes[&(low, high)].shift(arrow);
            let aside = shift.clamp(-ASIDE, ASIDE);
            let shift = Point::new(0.0, shift);
            let label = Point::new(edge.x.unwrap_or(0.0), edge.y.unwrap_or(0.0)) + shift;
            // The first and the last point lie on the boxes, not the circles.
            let inner = edge.points.len().saturating_sub(2);
            let mut through: Vec<Point> = (edge.points.iter().skip(1).take(inner))
                .map(|point| Point::new(point.x, point.y) + shift)
                .collect();
            if through.is_empty() {
                through.push(label);
            }
            if arrow.from > arrow.to {
                through.reverse();
            }
            Route {
                through,
                label,
                aside,
            }
        })
        .collect();
    Plan { centres, routes }
}

/// The room for what runs between two states: one arrow, or one there and one
/// back.
#[derive(Default)]
struct Lane {
    width: f64,
    height: f64,
    arrows: usize,
}

impl Lane {
    /// How far below the middle of the lane the arrow runs: the way there below
    /// the way back.
    fn shift(&self, arrow: &Arrow) -> f64 {
        let room = (self.height - arrow.label.height()) / 2.0;
        match (self.arrows, arrow.from < arrow.to) {
            (1, _) => 0.0,
            (_, true) => room,
            (_, false) => -room,
        }
    }
}

/// The ends of an arrow, the one that comes first in the order first.
fn ends(arrow: &Arrow) -> (usize, usize) {
    (arrow.from.min(arrow.to), arrow.from.max(arrow.to))
}

/// The lanes by their ends.
fn lanes(sketch: &Sketch) -> BTreeMap<(usize, usize), Lane> {
    let mut lanes: BTreeMap<(usize, usize), Lane> = BTreeMap::new();
    for arrow in &sketch.arrows {
        let lane = lanes.entry(ends(arrow)).or_default();
        if lane.arrows > 0 {
            lane.height += BETWEEN;
        }
        lane.width = lane.width.max(arrow.label.width);
        lane.height += arrow.label.height();
        lane.arrows += 1;
    }
    lanes
}
