;; What the robot executes, in the plan language of CRAM: look for the box, take it, put it on the
;; right.

(defparameter *left*
  (make-pose-stamped "map" 0.0 (make-3d-vector @X@ @LEFT@ @TOP@) (make-identity-rotation)))
(defparameter *right*
  (make-pose-stamped "map" 0.0 (make-3d-vector @X@ @RIGHT@ @TOP@) (make-identity-rotation)))

(def-cram-function bring ()
  (let ((?left *left*)
        (?right *right*))
    (perform (a motion (type looking) (target (a location (pose ?left)))))
    (perform (a motion (type detecting) (object (an object (name box)))))
    (perform (an action (type picking-up) (object (an object (name box)))))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?right)))))
    (perform (an action (type parking-arms)))))

(bring)
