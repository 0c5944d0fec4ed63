//! Points from files: reading, neighbours, spacing, normals, winding number.
