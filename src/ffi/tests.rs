//! What C callers can do wrong, and what they get.
