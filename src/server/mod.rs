//! Pages and API over sessions. Must not know SAT or encodings.
