;; Fetch the box from the second region and bring it to x = 0.5.

(defparameter *pick-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))
(defparameter *place-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.5 0 0) (make-identity-rotation)))

(def-cram-function fetch-box ()
  (let ((?there *pick-pose*)
        (?here *place-pose*))
    (perform (a motion (type going) (pose ?there)))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (a motion (type going) (pose ?here)))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?here)))))))

(fetch-box)
