use super::*;
use crate::joint_bones;
use core::f32::consts::PI;
use footfall_core::rotation::from_heading;

/// A character as an engine holds it: a rig and the poses of its bones.
#[derive(Clone)]
struct Character {
    rig: RestRig,
    poses: Vec<Affine3A>,
}

impl Bones for Character {
    fn transform(&self, bone: usize) -> Affine3A {
        self.poses[bone]
    }

    fn set_rotation(&mut self, bone: usize, rotation: Quat) {
        self.poses[bone] =
            Affine3A::from_rotation_translation(rotation, self.poses[bone].translation.into());
    }

    fn set_position(&mut self, bone: usize, position: Vec3) {
        self.poses[bone].translation = position.into();
    }
}

impl Character {
    /// Place of a bone in the space of the rig.
    fn place(&self, bone: usize) -> Vec3 {
        let above = self.rig.rig().above(bone);
        let chain = above.fold(self.poses[bone], |below, above| self.poses[above] * below);
        chain.translation.into()
    }
}

/// Rotation of a bone's own axes in the rest pose: another one for each, as bones of real rigs have.
fn axes(bone: usize) -> Quat {
    Quat::from_euler(glam::EulerRot::YXZ, 0.7 * bone as f32, 1.3, -0.4)
}

/// Centimetres, facing -X, arms lowered, every bone with axes of its own, a twist bone above each lower leg, and an armature that lies down.
fn crooked() -> Character {
    let body = Skeleton::standard();
    let mut pose = Pose::rest(&body);
    for (joint, side) in [(Joint::LeftUpperArm, 1.0), (Joint::RightUpperArm, -1.0)] {
        pose.rotations[joint.index()] = Quat::from_rotation_z(-0.9 * side);
    }
    let model = ModelPose::of(&body, &pose);
    let rig_from_ground = Affine3A::from_scale_rotation_translation(
        Vec3::splat(100.0),
        from_heading(-0.5 * PI),
        Vec3::new(30.0, 0.0, -20.0),
    );
    let lies = Affine3A::from_rotation_x(-0.5 * PI);
    let mut in_rig = vec![lies];
    let mut bones = vec![("Armature".to_owned(), None, lies)];
    let mut of_joint = [0; JOINT_COUNT];
    for joint in Joint::ALL {
        let mut parent = joint.parent().map_or(0, |parent| of_joint[parent.index()]);
        let mut add = |name: String, parent: usize, place: Vec3| {
            let own = Affine3A::from_rotation_translation(axes(bones.len()), place);
            bones.push((name, Some(parent), in_rig[parent].inverse() * own));
            in_rig.push(own);
            in_rig.len() - 1
        };
        let place = rig_from_ground.transform_point3(model.position(joint));
        if let Some(above) = joint.parent()
            && matches!(joint, Joint::LeftLowerLeg | Joint::RightLowerLeg)
        {
            let halfway = 0.5 * (model.position(joint) + model.position(above));
            let halfway = rig_from_ground.transform_point3(halfway);
            parent = add(format!("twist of {}", joint.name()), parent, halfway);
        }
        of_joint[joint.index()] = add(joint.name().to_owned(), parent, place);
    }
    let poses = bones.iter().map(|(.., rest)| *rest).collect();
    let rig = RestRig::new(bones);
    Character { rig, poses }
}

fn bound(character: &Character) -> (RigBinding, [usize; JOINT_COUNT]) {
    let bones = joint_bones(character.rig.rig(), &[None; JOINT_COUNT]).unwrap();
    let metres = Affine3A::from_scale(Vec3::splat(0.01));
    let binding = RigBinding::new(&character.rig, &bones, &metres).unwrap();
    (binding, bones.map(Option::unwrap))
}

/// A stride with a turned trunk and a raised arm.
fn stride(body: &Skeleton) -> Pose {
    let mut pose = Pose::rest(body);
    pose.root_position += Vec3::new(0.2, -0.05, 0.4);
    pose.rotations[Joint::Hips.index()] = Quat::from_rotation_y(0.6);
    pose.rotations[Joint::Chest.index()] = Quat::from_rotation_x(0.3);
    pose.rotations[Joint::LeftUpperLeg.index()] = Quat::from_rotation_x(-0.7);
    pose.rotations[Joint::LeftLowerLeg.index()] = Quat::from_rotation_x(0.9);
    pose.rotations[Joint::RightUpperArm.index()] = Quat::from_rotation_z(-1.2);
    pose
}

/// Largest distance of a joint's bone from where the pose has the joint, metres.
fn farthest(
    character: &Character,
    binding: &RigBinding,
    bones: &[usize; JOINT_COUNT],
    pose: &Pose,
) -> f32 {
    let model = ModelPose::of(&binding.body, pose);
    let off = |joint: Joint| {
        let wanted = binding
            .character_from_ground
            .transform_point3(model.position(joint));
        (0.01 * character.place(bones[joint.index()])).distance(wanted)
    };
    Joint::ALL.into_iter().map(off).fold(0.0, f32::max)
}

#[test]
fn a_crooked_rig_is_measured_as_the_body_that_it_is() {
    let character = crooked();
    let (binding, _) = bound(&character);
    let standard = Skeleton::standard();
    for joint in Joint::ALL {
        let [own, expected] = [&binding.body, &standard].map(|body| body.offset(joint));
        assert!(own.distance(expected) < 1e-3, "{joint:?}: {own}");
    }
    let forward = binding.character_from_ground.transform_vector3(Vec3::Z);
    assert!(forward.distance(Vec3::NEG_X) < 1e-3, "{forward}");
    let floor = Vec3::from(binding.character_from_ground.translation);
    assert!(floor.distance(Vec3::new(0.3, 0.0, -0.2)) < 1e-3, "{floor}");
}

#[test]
fn a_character_goes_where_its_body_walks_however_its_rig_stands_in_it() {
    let mut character = crooked();
    let (mut binding, bones) = bound(&character);
    let world_from_ground = Frame {
        position: Vec3::new(4.0, 0.5, -7.0),
        rotation: from_heading(0.8),
    };
    let world_from_character = binding.world_from_character(&world_from_ground);
    let pose = stride(&binding.body);
    binding.write(&mut character, &pose);
    let model = ModelPose::of(&binding.body, &pose);
    for joint in Joint::ALL {
        let seen = world_from_character.point(0.01 * character.place(bones[joint.index()]));
        let wanted = world_from_ground.point(model.position(joint));
        assert!(
            seen.distance(wanted) < 1e-3,
            "{joint:?}: {seen} for {wanted}"
        );
    }
    let again = binding.world_from_ground(&world_from_character);
    assert!(again.position.distance(world_from_ground.position) < 1e-5);
    assert!(again.rotation.angle_between(world_from_ground.rotation) < 1e-3);
}

#[test]
fn a_written_pose_puts_every_joint_in_its_place_and_is_read_again() {
    let mut character = crooked();
    let (mut binding, bones) = bound(&character);
    let pose = stride(&binding.body);
    assert!(farthest(&character, &binding, &bones, &pose) > 0.3);
    binding.write(&mut character, &pose);
    let off = farthest(&character, &binding, &bones, &pose);
    assert!(off < 2e-4, "{off}");

    let mut again = Pose::default();
    binding.read(&character, &mut again);
    assert!(again.root_position.distance(pose.root_position) < 1e-4);
    for (read, written) in again.rotations.iter().zip(&pose.rotations) {
        assert!(read.angle_between(*written) < 2e-3);
    }
}

#[test]
fn legs_are_written_and_read_without_the_trunk() {
    let mut character = crooked();
    let (mut binding, bones) = bound(&character);
    let arm = bones[Joint::RightUpperArm.index()];
    let before = character.clone();
    let pose = stride(&binding.body);
    binding.write_legs(&mut character, &pose);
    assert_eq!(character.poses[arm], before.poses[arm]);
    let leg = bones[Joint::LeftUpperLeg.index()];
    assert!(character.rotation(leg).angle_between(before.rotation(leg)) > 0.5);
    let mut again = Pose::default();
    binding.read_legs(&character, &mut again);
    let knee = Joint::LeftLowerLeg.index();
    assert!(again.rotations[knee].angle_between(pose.rotations[knee]) < 2e-3);
    assert_eq!(
        again.rotations[Joint::RightUpperArm.index()],
        Quat::IDENTITY
    );
}

#[test]
fn layers_leave_an_arm_to_other_animation_and_the_rest_to_the_gait() {
    let mut layered = crooked();
    let (mut binding, bones) = bound(&layered);
    let pose = stride(&binding.body);
    let mut written = layered.clone();
    binding.write(&mut written, &pose);
    let mut weights = LayerWeights {
        spine: 1.0,
        head: 1.0,
        left_arm: 1.0,
        right_arm: 0.0,
    };
    let arm = bones[Joint::RightUpperArm.index()];
    let own = layered.poses[arm];
    binding.write_layered(&mut layered, &pose, &weights);
    assert_eq!(layered.poses[arm], own);
    for joint in [Joint::Hips, Joint::Head, Joint::LeftHand, Joint::LeftFoot] {
        let bone = bones[joint.index()];
        let off = 0.01 * layered.place(bone).distance(written.place(bone));
        assert!(off < 1e-3, "{joint:?}: {off} m");
    }
    weights.right_arm = 0.5;
    binding.write_layered(&mut layered, &pose, &weights);
    let half = layered.rotation(arm);
    let ends = [of_transform(&own), written.rotation(arm)];
    assert!(ends.iter().all(|end| half.angle_between(*end) > 0.2));
}

#[test]
fn rest_poses_of_bones_become_the_t_pose() {
    let character = crooked();
    let (binding, bones) = bound(&character);
    let t_pose = binding.t_pose_of_bones(&character.rig);
    let model = ModelPose::of(&binding.body, &Pose::rest(&binding.body));
    for joint in Joint::ALL {
        let bone = bones[joint.index()];
        let (moved_by, ground_from_rest) = t_pose[bone];
        assert_eq!(moved_by, joint);
        let place = ground_from_rest.transform_point3(character.place(bone));
        assert!(place.distance(model.position(joint)) < 1e-3, "{joint:?}");
    }
    assert_eq!(
        t_pose[0].0,
        Joint::Hips,
        "what is above the hips moves along"
    );
    let twist = bones[Joint::LeftLowerLeg.index()] - 1;
    assert_eq!(t_pose[twist].0, Joint::LeftUpperLeg);
}

#[test]
fn bones_that_hang_elsewhere_and_bodies_that_lie_are_refused_by_name() {
    let character = crooked();
    let mut bones = joint_bones(character.rig.rig(), &[None; JOINT_COUNT]).unwrap();
    bones.swap(Joint::LeftHand.index(), Joint::LeftLowerArm.index());
    let error = RigBinding::new(&character.rig, &bones, &Affine3A::IDENTITY).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("bone LeftHand (LeftLowerArm)"),
        "{error}"
    );
    bones.swap(Joint::LeftHand.index(), Joint::LeftLowerArm.index());
    // It faces -X, so about X it falls on its side.
    let on_its_side = Affine3A::from_rotation_x(0.5 * PI);
    let error = RigBinding::new(&character.rig, &bones, &on_its_side).unwrap_err();
    assert_eq!(error, BindingError::NotStanding);
}

#[test]
fn sizes_are_compared_and_other_transforms_are_not_the_same() {
    let measured = Affine3A::from_scale_rotation_translation(
        Vec3::splat(0.01),
        Quat::from_rotation_y(0.3),
        Vec3::new(0.0, 0.2, 0.0),
    );
    let twice = Affine3A::from_scale(Vec3::splat(2.0)) * measured;
    assert!((relative_size(&measured, &twice).unwrap() - 2.0).abs() < 1e-5);
    let turned = Affine3A::from_rotation_y(0.1) * measured;
    assert_eq!(relative_size(&measured, &turned), None);
    let gone = Affine3A::from_scale(Vec3::ZERO);
    assert_eq!(relative_size(&measured, &gone), None);
}
