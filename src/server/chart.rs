//! Two limits as an area: what is accepted, and what was said of single behaviours.

use crate::concept::Point;
use crate::learner::{Question, Reply};
use crate::session::{Atom, Session};
use crate::task::Axes;

/// The side of the area, in units of the drawing.
pub(crate) const SIDE: f64 = 240.0;

/// An area.
pub(crate) struct Chart {
    /// How far it is accepted to the right, and up.
    pub(crate) width: String,
    pub(crate) height: String,
    /// The top of what is accepted.
    pub(crate) top: String,
    pub(crate) across: AxisView,
    pub(crate) up: AxisView,
    pub(crate) said: Vec<SaidView>,
}

/// An axis, with its ends.
pub(crate) struct AxisView {
    pub(crate) name: String,
    pub(crate) best: String,
    pub(crate) worst: String,
}

/// Something that was said to be acceptable, or not.
pub(crate) struct SaidView {
    pub(crate) x: String,
    pub(crate) y: String,
    pub(crate) acceptable: bool,
}

impl Chart {
    /// Of the limits of a session; none where there are not two.
    pub(crate) fn of(axes: &Axes, most: &Point, session: &Session) -> Option<Self> {
        let [across, up] = axes.axes() else {
            return None;
        };
        let axis = |axis: &crate::task::Axis| AxisView {
            name: axis.name.clone(),
            best: axis.spell(axis.best),
            worst: axis.spell(axis.worst),
        };
        let place = |point: &Point| {
            let at: Vec<f64> = point.coordinates().collect();
            (SIDE * at[0], SIDE * (1.0 - at[1]))
        };
        let (width, top) = place(most);
        let said = session.standing().iter().filter_map(|standing| {
            let question = &session.asked(standing.number)?.question;
            let (atom, acceptable) = match (question, &standing.reply) {
                (Question::Membership { atom }, Reply::Accept) => (atom, true),
                (Question::Membership { atom }, Reply::Reject) => (atom, false),
                (_, Reply::Counterexample { atom, label }) => (atom, *label),
                _ => return None,
            };
            let Atom::Point(point) = atom else {
                return None;
            };
            let (x, y) = place(point);
            Some(SaidView {
                x: format!("{x:.1}"),
                y: format!("{y:.1}"),
                acceptable,
            })
        });
        Some(Self {
            width: format!("{width:.1}"),
            height: format!("{:.1}", SIDE - top),
            top: format!("{top:.1}"),
            across: axis(across),
            up: axis(up),
            said: said.collect(),
        })
    }

    /// Whether anything was said to be acceptable, or not.
    pub(crate) fn has(&self, acceptable: bool) -> bool {
        self.said.iter().any(|said| said.acceptable == acceptable)
    }
}
