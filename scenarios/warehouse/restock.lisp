;; Take a part with each hand, drive to the shelf, and put both into their slots.

(defparameter *shelf-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.0 0.0 0) (make-quaternion 0 0 1 0)))
(defparameter *bin-a*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.65 0.25 0.71) (make-identity-rotation)))
(defparameter *bin-b*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.65 -0.25 0.71) (make-identity-rotation)))
(defparameter *slot-1*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.70 -0.2 0.80) (make-identity-rotation)))
(defparameter *slot-2*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.70 0.2 0.80) (make-identity-rotation)))

(def-cram-function take (?arm ?part ?bin)
  (perform (a motion (type looking) (target (a location (pose ?bin)))))
  (perform (a motion (type detecting) (object (an object (name ?part)))))
  (perform (an action (type picking-up) (arm ?arm) (object (an object (name ?part)))))
  (perform (an action (type parking-arms) (arm ?arm))))

(def-cram-function put (?arm ?part ?slot)
  (perform (an action (type placing) (arm ?arm) (object (an object (name ?part)))
                      (target (a location (pose ?slot)))))
  (perform (an action (type parking-arms) (arm ?arm))))

(def-cram-function restock ()
  (let ((?there *shelf-pose*))
    (take 'left 'crate *bin-a*)
    (take 'right 'drum *bin-b*)
    (perform (a motion (type going) (target (a location (pose ?there)))))
    (put 'left 'crate *slot-1*)
    (put 'right 'drum *slot-2*)))

(restock)
