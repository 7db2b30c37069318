;; What the robot executes, in the plan language of CRAM: go to the box, pick it up, bring it back.

(defparameter *box-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))
(defparameter *home-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.5 0 0) (make-identity-rotation)))

(def-cram-function fetch ()
  (let ((?there *box-pose*)
        (?home *home-pose*))
    (perform (a motion (type going) (pose ?there)))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (a motion (type going) (pose ?home)))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?home)))))))

(fetch)
