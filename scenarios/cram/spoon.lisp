;; The spoon is taken out of the drawer, which stays open behind it.

(defparameter *sink-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.75 0.85 0) (make-identity-rotation)))
(defparameter *island-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.2 1.5 0) (make-quaternion 0 0 1 0)))
(defparameter *drawer*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.0 1.0 0.75) (make-identity-rotation)))

(def-cram-function drive-to (?pose)
  (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?pose))))))

(def-cram-function find-in (?pose ?type)
  (exe:perform (desig:a motion (type looking) (target (desig:a location (pose ?pose)))))
  (exe:perform (desig:a motion (type detecting) (object (desig:an object (type ?type))))))

(def-cram-function bring-spoon ()
  (exe:perform (desig:an action (type opening) (object (desig:an object (name drawer)))))
  (exe:perform (desig:an action (type parking-arms)))
  (let ((?spoon (find-in *drawer* :spoon)))
    (exe:perform (desig:an action (type picking-up) (object ?spoon)))
    (exe:perform (desig:an action (type parking-arms)))
    (drive-to *island-pose*)
    (drive-to *sink-pose*)))

(bring-spoon)
