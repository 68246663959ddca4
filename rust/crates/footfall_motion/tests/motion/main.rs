//! Tests of the crate as its users see it, in one program: linked once, and run side by side.

mod bvh;
mod common;
mod contacts;
mod contacts_of_people;
mod corpus;
mod directions;
mod head_carriage;
mod hip_centres;
mod people;
mod retarget;
mod switches;
