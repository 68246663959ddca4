//! Feature layout, gait models and their versioned files.
