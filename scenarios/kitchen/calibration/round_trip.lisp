;; To the table, home and back to the counter, with empty hands.

(in-package :kitchen-demo)

(def-cram-function drive-to (?x ?y ?orientation)
  (let ((?pose (make-pose-stamped "map" 0.0 (make-3d-vector ?x ?y 0) ?orientation)))
    (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?pose)))))))

(drive-to -0.10 0.56 (make-quaternion 0 0 1 0))
(drive-to -0.05 -0.85 (make-identity-rotation))
(drive-to 0.72 0.06 (make-identity-rotation))
