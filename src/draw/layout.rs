//! Where circles and labels stand: a layered layout, left to right, by `dagre`.
//!
//! Every arrow is handed over in the direction of the breadth-first order, the
//! way back as well: the graph is then free of cycles, the start alone is in
//! the first layer, and no cycle breaker turns a square into a chain.

use dagre::graph::{Graph, GraphOptions};
use dagre::{EdgeLabel, LayoutOptions, NodeLabel, RankDir};

use super::curve::{LOOP_HEIGHT, Point, RADIUS};
use super::sketch::Sketch;

/// The free space around a label, in pixels.
pub(super) const PADDING: f64 = 4.0;

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
        if let Some(label) = &state.looping {
            // Room for the loop on top, and as much below: boxes are centred.
            node.width = node.width.max(label.width + 2.0 * PADDING);
            node.height += 2.0 * (LOOP_HEIGHT + label.height());
        }
        graph.set_node(index.to_string(), Some(node));
    }
    for (index, arrow) in sketch.arrows.iter().enumerate() {
        let (low, high) = (arrow.from.min(arrow.to), arrow.from.max(arrow.to));
        let edge = EdgeLabel {
            width: arrow.label.width + 2.0 * PADDING,
            height: arrow.label.height() + 2.0 * PADDING,
            labelpos: dagre::layout::types::LabelPos::Center,
            ..EdgeLabel::default()
        };
        let name = index.to_string();
        graph.set_edge(low.to_string(), high.to_string(), Some(edge), Some(&name));
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
    let routes = (sketch.arrows.iter().enumerate())
        .map(|(index, arrow)| {
            let (low, high) = (arrow.from.min(arrow.to), arrow.from.max(arrow.to));
            let edge = graph.edge(
                &low.to_string(),
                &high.to_string(),
                Some(&index.to_string()),
            );
            let edge = edge.expect("the layout keeps every edge");
            let label = Point::new(edge.x.unwrap_or(0.0), edge.y.unwrap_or(0.0));
            // The first and the last point lie on the boxes, not the circles.
            let inner = edge.points.len().saturating_sub(2);
            let mut through: Vec<Point> = (edge.points.iter().skip(1).take(inner))
                .map(|point| Point::new(point.x, point.y))
                .collect();
            if through.is_empty() {
                through.push(label);
            }
            if arrow.from > arrow.to {
                through.reverse();
            }
            Route { through, label }
        })
        .collect();
    Plan { centres, routes }
}
