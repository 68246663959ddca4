//! Runtime: leg inverse kinematics and foot locking.
