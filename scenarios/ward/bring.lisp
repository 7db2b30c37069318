;; Take the can from the cupboard and bring it to the bed.

(defun place-at (x y z)
  (make-pose-stamped "map" 0.0 (make-3d-vector x y z) (make-identity-rotation)))

(defparameter *bed* (place-at 0.0 -2.6 0))
(defparameter *cupboard* (place-at 0.85 0.0 0.8))
(defparameter *table* (place-at 0.7 -2.6 0.75))

(def-cram-function take-can ()
  (let ((?cupboard *cupboard*))
    (perform (a motion (type looking) (target (a location (pose ?cupboard)))))
    (perform (a motion (type detecting) (object (an object (name can)))))
    (perform (an action (type picking-up) (object (an object (name can)))))
    (perform (an action (type parking-arms)))))

(def-cram-function bring-can ()
  (let ((?bed *bed*)
        (?table *table*))
    (take-can)
    (perform (a motion (type going) (target (a location (pose ?bed)))))
    (perform (an action (type placing) (object (an object (name can)))
                        (target (a location (pose ?table)))))))

(bring-can)
