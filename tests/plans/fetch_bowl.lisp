;; Take the bowl from whichever cell of the counter it is on; look once more before giving up.

(defparameter *cells*
  (list (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.075 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.225 0.85) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 0.375 0.85) (make-identity-rotation))))

(def-cram-function fetch-bowl ()
  (let ((?bowl nil))
    (dolist (?cell *cells*)
      (exe:perform (desig:a motion (type looking) (target (desig:a location (pose ?cell)))))
      (with-failure-handling
          ((perception-low-level-failure (e)
             (roslisp:ros-warn (demo) "no bowl: ~a" e)
             (return)))
        (setf ?bowl (exe:perform (desig:a motion (type detecting)
                                          (object (desig:an object (type bowl)))))))
      (when ?bowl (return)))
    (unless ?bowl (cpl:fail 'object-nowhere-to-be-found))
    (exe:perform (desig:an action (type picking-up) (arm right) (object ?bowl)))))
