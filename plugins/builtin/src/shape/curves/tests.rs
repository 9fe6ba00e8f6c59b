//! What curves promise.
