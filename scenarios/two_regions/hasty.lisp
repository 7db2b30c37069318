;; Picks the box up without going to it first.

(defparameter *place-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.5 0 0) (make-identity-rotation)))

(def-cram-function fetch-in-haste ()
  (let ((?here *place-pose*))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (a motion (type going) (pose ?here)))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?here)))))))

(fetch-in-haste)
