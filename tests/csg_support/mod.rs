//! What the tests of CSG share: seeded draws that like ties, leaves on a line, random objects, an evaluator that
//! takes no short cut, and scenes from text.
#![allow(dead_code)]

pub mod draws;
pub mod forest;
pub mod frames;
pub mod line;
pub mod oracle;
pub mod scene;
