#!/usr/bin/python3
"""Solves a camera from board corners with mrcal and prints how far its projection is to be trusted.

Reads one JSON object from stdin: columns, rows, spacing (metres), size, lens (fx, fy, cx, cy, k1, k2, p1, p2), poses
(Rodrigues vector and metres, board to camera), corners (views x rows x columns x 2) and points (camera frame, metres).
Prints the standard deviation in the worst direction at each point, pixels, one a line.
"""
import json
import sys

import mrcal
import numpy as np

given = json.load(sys.stdin)
views = len(given["poses"])
corners = np.array(given["corners"], dtype=float).reshape(views, given["rows"], given["columns"], 2)
observations = np.concatenate((corners, np.ones(corners.shape[:-1] + (1,))), axis=-1)
inputs = dict(
    lensmodel="LENSMODEL_OPENCV4",
    intrinsics=np.array([given["lens"]], dtype=float),
    extrinsics_rt_fromref=np.zeros((0, 6)),
    frames_rt_toref=np.array(given["poses"], dtype=float),
    points=None,
    observations_board=observations,
    indices_frame_camintrinsics_camextrinsics=np.array([[v, 0, -1] for v in range(views)], dtype=np.int32),
    observations_point=None,
    indices_point_camintrinsics_camextrinsics=None,
    imagersizes=np.array([given["size"]], dtype=np.int32),
    calobject_warp=None,
    calibration_object_spacing=given["spacing"],
    do_optimize_intrinsics_core=True,
    do_optimize_intrinsics_distortions=True,
    do_optimize_extrinsics=True,
    do_optimize_frames=True,
    do_optimize_calobject_warp=False,
    do_apply_regularization=False,
    do_apply_outlier_rejection=False,
)
mrcal.optimize(**inputs)
model = mrcal.cameramodel(optimization_inputs=inputs, icam_intrinsics=0)
for point in given["points"]:
    print(mrcal.projection_uncertainty(np.array(point, dtype=float), model, what="worstdirection-stdev"))
