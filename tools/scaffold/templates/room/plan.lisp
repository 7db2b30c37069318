;; What the robot executes, in the plan language of CRAM: look for the box, take it, bring it to the
;; shelf.

(defparameter *table*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.65 0 0.70) (make-identity-rotation)))
(defparameter *shelf-front*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.05 0 0) (make-quaternion 0 0 1 0)))
(defparameter *shelf*
  (make-pose-stamped "map" 0.0 (make-3d-vector -1.70 0 0.80) (make-identity-rotation)))

(def-cram-function bring ()
  (let ((?table *table*)
        (?front *shelf-front*)
        (?shelf *shelf*))
    (perform (a motion (type looking) (target (a location (pose ?table)))))
    (perform (a motion (type detecting) (object (an object (name box)))))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (an action (type parking-arms)))
    (perform (a motion (type going) (target (a location (pose ?front)))))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?shelf)))))))

(bring)
