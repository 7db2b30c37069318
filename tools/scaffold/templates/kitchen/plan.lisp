;; What the robot executes, in the plan language of CRAM: look for the tin on the counter and then in
;; the drawer, take it and put it on the counter.

(defparameter *counter*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.74 -0.05 0.85) (make-identity-rotation)))

(def-cram-function see (?spot)
  (perform (a motion (type looking) (target (a location (in (an object (name ?spot)))))))
  (perform (a motion (type detecting) (object (an object (name tin))))))

;; One place after the other. What is not seen at the first one is a failure, which is handled; at
;; the last one it ends the plan.
(def-cram-function find-tin ()
  (dolist (?spot '(:on-counter :in-drawer))
    (when (eq ?spot :in-drawer)
      (perform (an action (type opening) (object (an object (name drawer)))))
      (perform (an action (type parking-arms))))
    (when (with-failure-handling
              ((perception-object-not-found (e) (when (eq ?spot :on-counter) (return nil))))
            (see ?spot))
      (return))))

(def-cram-function fetch ()
  (let ((?counter *counter*))
    (find-tin)
    (perform (an action (type picking-up) (object (an object (name tin)))))
    (perform (an action (type parking-arms)))
    (perform (an action (type placing) (object (an object (name tin)))
                        (target (a location (pose ?counter)))))))

(fetch)
