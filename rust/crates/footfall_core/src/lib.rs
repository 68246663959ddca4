//! Skeleton, pose, clip, rotations, forward kinematics and the humanoid profile.
