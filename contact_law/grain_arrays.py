"""The grains and contacts of the running scene as numpy arrays."""

import numpy as np

OF_PLANES = {
    "plane_axis": np.int32,
    "plane_position": float,
    "plane_contacts": np.int32,
    "plane_contact_normal_force": float,
}


def snapshot():
    """Everything about the grains and their contacts at one moment, as a dict of arrays in SI units.

    Keys: time [s]; rows in the order of body ids: ids (N,), position (N, 3) [m], velocity (N, 3) [m/s], angular_velocity (N, 3) [rad/s],
    radius (N,) [m] (of sintered grains that before they shrank); contacts: contact_pairs (M, 2) (row numbers), contact_normal_force (M,) [N] (elastic and viscous, positive when
    repulsive), contact_bonded (M,) bool (sintered bonds), contact_neck (M,) (of bonds, the neck's radius over that of the grains; 0: none).
    In a scene with planes (Walls) also, of the planes in the order of body ids: plane_axis (P,) (0, 1, 2), plane_position (P,) [m] (along that axis);
    of the grains on them: plane_contacts (K, 2) (row of the grain, row of the plane), plane_contact_normal_force (K,) [N].
    In a periodic scene also cell_size (3,) [m], the box's; positions are unwrapped, and a contact is of the nearest images.

    Call it from a PyRunner that stands last among O.engines. NewtonIntegrator keeps velocities half a step apart from positions and
    has moved the grains on by then; the arrays are brought to the moment of the forces, which is also that of O.energy.

    RuntimeError while O.run() is under way (but for PyRunners), and when JKRWadaEngine's grains are not the scene's bodies any more: erased, or of another scene.
    """
    from yade.wrapper import JKRWadaSnapshot

    raw = JKRWadaSnapshot().read()
    vectors = {name: np.frombuffer(raw[name]).reshape(-1, 3) for name in ("position", "velocity", "angular_velocity")}
    neck = np.frombuffer(raw["contact_neck"])
    planes = {name: np.frombuffer(raw[name], dtype=kind) for name, kind in OF_PLANES.items() if name in raw}
    if planes:
        planes["plane_contacts"] = planes["plane_contacts"].reshape(-1, 2)
    cell = {"cell_size": np.frombuffer(raw["cell_size"])} if "cell_size" in raw else {}
    return {
        **cell,
        **planes,
        "time": raw["time"],
        "ids": np.frombuffer(raw["ids"], dtype=np.int32),
        **vectors,
        "radius": np.frombuffer(raw["radius"]),
        "contact_pairs": np.frombuffer(raw["contact_pairs"], dtype=np.int32).reshape(-1, 2),
        "contact_normal_force": np.frombuffer(raw["contact_normal_force"]),
        "contact_bonded": neck > 0,
        "contact_neck": neck,
    }
