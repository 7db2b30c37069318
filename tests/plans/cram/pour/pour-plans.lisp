(in-package :pour-plans)

(defparameter *approach-height* 0.15)
(defparameter *tilt-steps* 3)

(defun pouring-poses (container-pose &key (height *approach-height*) (steps *tilt-steps*))
  "Poses above the container, each one a little lower than the one before."
  (let* ((origin (cl-transforms:origin container-pose))
         (offsets (make-list steps :initial-element (/ height steps))))
    (loop for offset in offsets
          for number from 1
          collect (cl-transforms-stamped:make-pose-stamped
                   (cl-transforms-stamped:frame-id container-pose)
                   0.0
                   (cl-transforms:make-3d-vector
                    (cl-transforms:x origin)
                    (cl-transforms:y origin)
                    (+ (cl-transforms:z origin) (- height (* (1- number) offset))))
                   (cl-transforms:orientation container-pose)))))

(defun arms-apart (source-arm target-arm)
  (when (eq source-arm target-arm)
    (error "one arm cannot hold both")))

(defun take (?object ?arm ?location)
  (exe:perform (desig:an action (type turning-towards) (target ?location)))
  (let ((?seen (exe:perform (desig:an action (type perceiving) (object ?object)))))
    (mob:pick-up-with ?seen ?arm :grasp :front)
    ?seen))

(defun look-at-rim (poses)
  "The eyes follow the hands down; the kitchen's gaze knows the cell alone."
  (mapcar (lambda (pose number)
            (roslisp:ros-info (pour look) "~a at ~a" number pose)
            (cl-transforms:z (cl-transforms:origin pose)))
          poses
          (loop for number from 1 to (length poses) collect number)))

(defun pour (&key
               ((:source ?source))
               ((:target ?target))
               ((:source-location ?source-location))
               ((:target-location ?target-location))
               ((:source-arm ?source-arm))
               ((:target-arm ?target-arm))
               ((:poses poses))
             &allow-other-keys)
  "Takes the source in one hand and the target in the other, and tilts the one over the other."
  (declare (type list poses))
  (handler-case (arms-apart ?source-arm ?target-arm)
    (simple-error (e)
      (roslisp:ros-warn (pour pour) "~a" e)
      (cpl:fail 'common-fail:object-unreachable)))
  (take ?target ?target-arm ?target-location)
  (cpl:with-retry-counters ((source-retries 1))
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (e)
           (roslisp:ros-warn (pour pour) "where is it? ~a" e)
           (cpl:do-retry source-retries
             (cpl:retry))
           (cpl:fail 'common-fail:object-nowhere-to-be-found)))
      (take ?source ?source-arm ?source-location)))
  (cpl:pursue
    (exe:perform (desig:an action (type raising-torso) (height torso-high)))
    (roslisp:ros-info (pour pour) "watching"))
  (let ((heights (look-at-rim poses)))
    (unless (and heights (every #'numberp heights))
      (cpl:fail 'common-fail:manipulation-goal-not-reached))
    (tilt ?source-arm (first heights) (car (last heights)))))

(defun tilt (?arm from to)
  (assert-order from to)
  (cpl:par
    (exe:perform (desig:a motion (type tilting) (arm ?arm)))
    (roslisp:ros-info (pour tilt) "from ~a to ~a" from to))
  t)

(defun assert-order (from to)
  (when (< from to)
    (error "pouring goes downwards: ~a, ~a" from to)))
