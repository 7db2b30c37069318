;; Places of the office, and what all plans of this folder do with their hand and at the door.

(defun place-at (x y z)
  (make-pose-stamped "map" 0.0 (make-3d-vector x y z) (make-identity-rotation)))

(defparameter *kitchen*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.0 -2.35 0) (make-quaternion 0 0 -0.7071068 0.7071068)))
(defparameter *corridor*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.5 0.0 0) (make-quaternion 0 0 -0.7071068 0.7071068)))
(defparameter *front* (place-at -0.8 0.05 0))
(defparameter *front-leaving*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.8 0.05 0) (make-quaternion 0 0 1 0)))
(defparameter *aside*                   ; turned to the hinge
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.04 0.21 0) (make-quaternion 0 0 -0.3221525 0.9466878)))
(defparameter *room* (place-at 0.9 0.05 0))
(defparameter *room-leaving*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.9 0.05 0) (make-quaternion 0 0 1 0)))
(defparameter *desk* (place-at 1.18 1.2 0))
(defparameter *lane* (place-at 2.68 0.05 0))
(defparameter *window*
  (make-pose-stamped "map" 0.0 (make-3d-vector 2.68 1.2 0) (make-quaternion 0 0 1 0)))
(defparameter *desk-top* (place-at 1.9 1.2 0.77))
(defparameter *counter-top* (place-at -1.0 -3.1 0.9))

(def-cram-function drive-to (?pose)
  (perform (a motion (type going) (target (a location (pose ?pose))))))

(def-cram-function park-arm ()
  (perform (an action (type parking-arms))))

(def-cram-function find-mug ()
  (let ((?top *desk-top*))
    (perform (a motion (type looking) (target (a location (pose ?top)))))
    (perform (a motion (type detecting) (object (an object (name mug1)))))))

(def-cram-function take-mug ()
  (find-mug)
  (perform (an action (type picking-up) (object (an object (name mug1))))))

(def-cram-function put-mug ()
  (let ((?top *counter-top*))
    (perform (an action (type placing) (object (an object (name mug1)))
                        (target (a location (pose ?top)))))
    (park-arm)))

(def-cram-function open-door-from (?pose)
  (drive-to ?pose)
  (perform (an action (type opening) (object (an object (name office-door)))))
  (park-arm))
