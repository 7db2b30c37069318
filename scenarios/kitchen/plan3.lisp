;; Look into the drawers from several places to stand, and take the spoon out.

(in-package :kitchen-demo)

(defparameter *stances*
  (list (make-pose-stamped "map" 0.0 (make-3d-vector 0.66 0.00 0) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0) (make-identity-rotation))
        (make-pose-stamped "map" 0.0 (make-3d-vector 0.78 0.12 0) (make-identity-rotation))))

(def-cram-function park ()
  (exe:perform (desig:an action (type parking-arms) (arm left))))

(def-cram-function open-drawer (?drawer)
  (exe:perform (desig:an action (type opening) (arm left)
                         (object (desig:an object (name ?drawer)))))
  (park))

(def-cram-function close-drawer (?drawer)
  (exe:perform (desig:an action (type closing) (arm left)
                         (object (desig:an object (name ?drawer)))))
  (park))

(defun look-into (?drawer)
  (let ((?open nil))
    (dolist (?stance *stances*)
      (exe:perform (desig:a motion (type going) (target (desig:a location (pose ?stance)))))
      (unless ?open
        (open-drawer ?drawer)
        (setf ?open t))
      (exe:perform (desig:a motion (type looking)
                            (target (desig:a location (in (desig:an object (name ?drawer)))))))
      (cpl:with-failure-handling
          ((common-fail:perception-low-level-failure (e)
             (roslisp:ros-warn (demo) "nothing to be seen from here: ~a" e)
             (return)))
        (let ((?spoon (exe:perform (desig:a motion (type detecting)
                                            (object (desig:an object (type spoon)))))))
          (exe:perform (desig:an action (type picking-up) (arm left) (object ?spoon)))
          (return-from look-into ?spoon))))
    nil))

(defun fetch-spoon ()
  (dolist (?drawer '(:d-top :d-mid :d-low))
    (let ((?spoon (look-into ?drawer)))
      (when ?spoon
        (return-from fetch-spoon ?spoon))
      (close-drawer ?drawer)))
  (cpl:fail 'common-fail:object-nowhere-to-be-found))

(fetch-spoon)
