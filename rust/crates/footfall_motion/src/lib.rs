//! Offline: BVH files, retargeting, contacts, steps and corpora.
