;; Fetch the box from the second region and place it at the very edge of the first.

(defparameter *pick-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 1.5 0 0) (make-identity-rotation)))
(defparameter *stand-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.7 0 0) (make-identity-rotation)))
(defparameter *edge-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.985 0 0) (make-identity-rotation)))

(def-cram-function fetch-box-to-edge ()
  (let ((?there *pick-pose*)
        (?stand *stand-pose*)
        (?edge *edge-pose*))
    (perform (a motion (type going) (pose ?there)))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (a motion (type going) (pose ?stand)))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?edge)))))))

(fetch-box-to-edge)
