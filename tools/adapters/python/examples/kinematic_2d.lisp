;; Through the door to the crate, and back with it.

(defparameter *crate-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 2.8 0 0) (make-identity-rotation)))
(defparameter *home-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.5 0 0) (make-identity-rotation)))

(def-cram-function fetch ()
  (let ((?there *crate-pose*)
        (?home *home-pose*))
    (perform (a motion (type going) (pose ?there)))
    (perform (an action (type picking-up) (object (an object (name crate)))))
    (perform (a motion (type going) (pose ?home)))
    (perform (an action (type placing) (object (an object (name crate)))
                        (target (a location (pose ?home)))))))

(fetch)
