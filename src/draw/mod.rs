//! Pictures of automata as SVG.
