//! The skeletons that are known by name.

use super::JointMap;
use crate::{JOINT_COUNT, Joint};

/// The maps of all families.
pub(super) fn known() -> Vec<JointMap> {
    FAMILIES.iter().map(Family::joint_map).collect()
}

/// Names of a family: trunk names as they are, limb names with `*` for the side.
struct Family {
    label: &'static str,
    /// Text in the place of `*`, on the left and on the right.
    sides: [&'static str; 2],
    /// From hips to head, in the order of the canonical joints; alternatives separated by `|`.
    trunk: [&'static str; 6],
    /// From collar bone to hand.
    arm: [&'static str; 4],
    /// From hip joint to toes.
    leg: [&'static str; 4],
}

const FAMILIES: [Family; 20] = [
    Family {
        label: "humanoid (Godot, VRM, Unity)",
        sides: ["Left", "Right"],
        trunk: ["Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"],
        arm: ["*Shoulder", "*UpperArm", "*LowerArm", "*Hand"],
        leg: ["*UpperLeg", "*LowerLeg", "*Foot", "*Toes|*ToeBase|*Toe"],
    },
    Family {
        label: "CMU (cgspeed)",
        sides: ["Left", "Right"],
        trunk: ["Hips", "LowerBack", "Spine", "Spine1", "Neck", "Head"],
        arm: ["*Shoulder", "*Arm", "*ForeArm", "*Hand"],
        leg: ["*UpLeg", "*Leg", "*Foot", "*ToeBase|*Toe"],
    },
    Family {
        label: "Mixamo and MotionBuilder",
        sides: ["Left", "Right"],
        trunk: ["Hips", "Spine", "Spine1", "Spine3|Spine2", "Neck", "Head"],
        arm: ["*Shoulder", "*Arm", "*ForeArm", "*Hand"],
        leg: ["*UpLeg", "*Leg", "*Foot", "*ToeBase|*Toe"],
    },
    Family {
        label: "Rokoko",
        sides: ["Left", "Right"],
        trunk: [
            "Hips",
            "Spine|Spine1",
            "Spine2",
            "Spine4|Spine3|Chest",
            "Neck",
            "Head",
        ],
        arm: ["*Shoulder", "*Arm|*UpperArm", "*ForeArm", "*Hand"],
        leg: ["*Thigh", "*Shin", "*Foot", "*Toe"],
    },
    Family {
        label: "Daz Genesis 3 and 8",
        sides: ["l", "r"],
        trunk: [
            "hip|pelvis",
            "abdomenLower",
            "chestLower",
            "chestUpper",
            "neckLower",
            "head",
        ],
        arm: ["*Collar", "*ShldrBend", "*ForearmBend", "*Hand"],
        leg: ["*ThighBend", "*Shin", "*Foot", "*Toe"],
    },
    Family {
        label: "Daz Genesis 9",
        sides: ["l_", "r_"],
        trunk: ["hip|pelvis", "spine1", "spine2", "spine4", "neck1", "head"],
        arm: ["*shoulder", "*upperarm", "*forearm", "*hand"],
        leg: ["*thigh", "*shin", "*foot", "*toes"],
    },
    Family {
        label: "older Daz and Poser",
        sides: ["l", "r"],
        trunk: ["hip|pelvis", "abdomen", "abdomen2", "chest", "neck", "head"],
        arm: ["*Collar", "*Shldr", "*ForeArm", "*Hand"],
        leg: ["*Thigh", "*Shin", "*Foot", "*Toe"],
    },
    Family {
        label: "Reallusion CC",
        sides: ["L_", "R_"],
        trunk: [
            "Hip",
            "Waist",
            "Spine01",
            "Spine02",
            "NeckTwist01|Neck",
            "Head",
        ],
        arm: ["*Clavicle", "*Upperarm", "*Forearm", "*Hand"],
        leg: ["*Thigh", "*Calf", "*Foot", "*ToeBase"],
    },
    Family {
        label: "MakeHuman",
        sides: [".L", ".R"],
        trunk: ["root", "spine05", "spine03", "spine01", "neck01", "head"],
        arm: ["clavicle*", "upperarm01*", "lowerarm01*", "wrist*"],
        // Its toes bend one by one, so none of them is the joint of all.
        leg: ["upperleg01*", "lowerleg01*", "foot*", ""],
    },
    Family {
        label: "Synty",
        sides: ["_L", "_R"],
        trunk: ["Hips", "Spine_01", "Spine_02", "Spine_03", "Neck", "Head"],
        arm: ["Clavicle*", "Shoulder*", "Elbow*", "Hand*"],
        leg: ["UpperLeg*", "LowerLeg*", "Ankle*", "Ball*"],
    },
    Family {
        label: "Auto-Rig Pro",
        sides: [".l", ".r"],
        trunk: [
            "root.x",
            "spine_01.x",
            "spine_02.x",
            "spine_03.x",
            "neck.x",
            "head.x",
        ],
        arm: [
            "shoulder*",
            "arm_stretch*|arm*",
            "forearm_stretch*|forearm*",
            "hand*",
        ],
        leg: [
            "thigh_stretch*|thigh*",
            "leg_stretch*|leg*",
            "foot*",
            "toes_01*",
        ],
    },
    Family {
        label: "Bandai Namco",
        sides: ["_L", "_R"],
        trunk: ["Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"],
        arm: ["Shoulder*", "UpperArm*", "LowerArm*", "Hand*"],
        leg: ["UpperLeg*", "LowerLeg*", "Foot*", "Toes*|Toe*"],
    },
    Family {
        label: "Rigify and Blender",
        sides: ["_L", "_R"],
        trunk: [
            "hips|pelvis|spine",
            "spine|spine_001",
            "chest|spine_001|spine_002",
            "upper_chest|spine_002|spine_003",
            "neck|spine_004",
            "head|spine_006",
        ],
        arm: [
            "shoulder*|clavicle*",
            "upper_arm*|upperarm*",
            "forearm*|lower_arm*",
            "hand*",
        ],
        leg: [
            "thigh*|upper_leg*",
            "shin*|calf*|lower_leg*",
            "foot*",
            "toe*|toes*",
        ],
    },
    Family {
        label: "Xsens and 100STYLE",
        sides: ["Left", "Right"],
        trunk: ["Hips", "Chest", "Chest2", "Chest4|Chest3", "Neck", "Head"],
        arm: ["*Collar", "*Shoulder", "*Elbow", "*Wrist"],
        leg: ["*Hip", "*Knee", "*Ankle", "*Toe|*Toes|*ToeBase"],
    },
    Family {
        label: "Xsens MVN",
        sides: ["Left", "Right"],
        trunk: ["Pelvis", "L5", "T12|L3", "T8", "Neck", "Head"],
        arm: ["*Shoulder", "*UpperArm", "*ForeArm", "*Hand"],
        leg: ["*UpperLeg", "*LowerLeg", "*Foot", "*Toe"],
    },
    Family {
        label: "SMPL and AMASS",
        sides: ["L_|Left", "R_|Right"],
        trunk: ["Pelvis", "Spine1", "Spine2", "Spine3", "Neck", "Head"],
        arm: ["*Collar", "*Shoulder", "*Elbow", "*Wrist"],
        leg: ["*Hip", "*Knee", "*Ankle", "*Foot|*Toe"],
    },
    Family {
        label: "Unreal",
        sides: ["_l", "_r"],
        trunk: [
            "pelvis",
            "spine_01",
            "spine_02|spine_03",
            "spine_05|spine_04|spine_03",
            "neck_01",
            "head",
        ],
        arm: ["clavicle*", "upperarm*", "lowerarm*", "hand*"],
        leg: ["thigh*", "calf*", "foot*", "ball*"],
    },
    Family {
        label: "3ds Max Biped",
        sides: ["L_", "R_"],
        trunk: ["Pelvis", "Spine", "Spine1", "Spine3|Spine2", "Neck", "Head"],
        arm: ["*Clavicle", "*UpperArm", "*Forearm", "*Hand"],
        leg: ["*Thigh", "*Calf", "*Foot", "*Toe0"],
    },
    Family {
        label: "VRoid",
        sides: ["L_", "R_"],
        trunk: [
            "C_Hips",
            "C_Spine",
            "C_Chest",
            "C_UpperChest",
            "C_Neck",
            "C_Head",
        ],
        arm: ["*Shoulder", "*UpperArm", "*LowerArm", "*Hand"],
        leg: ["*UpperLeg", "*LowerLeg", "*Foot", "*ToeBase"],
    },
    Family {
        label: "older BVH (Hips, LeftHip, LeftKnee)",
        sides: ["Left", "Right"],
        trunk: [
            "Hips|Hip|Root|ToSpine",
            "Spine|Chest|Abdomen",
            "Chest|Chest2|Thorax",
            "Chest3|UpperChest",
            "Neck",
            "Head",
        ],
        arm: [
            "*Collar|*Clavicle|*Shoulder",
            "*UpArm|*UpperArm|*Shoulder|*Arm",
            "*LowArm|*LowerArm|*Elbow|*ForeArm",
            "*Hand|*Wrist",
        ],
        leg: [
            "*UpLeg|*Thigh|*Hip|*UpperLeg|*Femur",
            "*LowLeg|*Shin|*Knee|*LowerLeg|*Tibia|*Leg",
            "*Foot|*Ankle",
            "*Toe|*Toes|*ToeBase",
        ],
    },
];

impl Family {
    fn joint_map(&self) -> JointMap {
        let mut names: [Vec<String>; JOINT_COUNT] = Default::default();
        let alternatives = |list: &str| {
            let names = list.split('|').filter(|name| !name.is_empty());
            names.map(str::to_owned).collect::<Vec<_>>()
        };
        for (joint, list) in Joint::ALL.into_iter().zip(self.trunk) {
            names[joint.index()] = alternatives(list);
        }
        let limbs = [
            (Joint::LeftShoulder, self.sides[0], self.arm),
            (Joint::RightShoulder, self.sides[1], self.arm),
            (Joint::LeftUpperLeg, self.sides[0], self.leg),
            (Joint::RightUpperLeg, self.sides[1], self.leg),
        ];
        for (first, side, limb) in limbs {
            for (n, list) in limb.iter().enumerate() {
                names[first.index() + n] = alternatives(list)
                    .iter()
                    .flat_map(|name| side.split('|').map(move |side| name.replace('*', side)))
                    .collect();
            }
        }
        JointMap {
            label: self.label.to_owned(),
            names,
        }
    }
}
