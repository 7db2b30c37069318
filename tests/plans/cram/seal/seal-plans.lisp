(in-package :seal-plans)

(defmacro with-open-container ((container arm) &body body)
  "Opens the container for BODY and shuts it whatever happens."
  `(let ((?container ,container)
         (?arm ,arm))
     (exe:perform (desig:an action (type opening) (arm ?arm) (object ?container)))
     (unwind-protect (progn ,@body)
       (exe:perform (desig:an action (type sealing) (object ?container) (arms (?arm)))))))

(defun push-shut (container arm)
  (let ((?container container)
        (?arm arm))
    (exe:perform (desig:an action (type closing) (arm ?arm) (object ?container)))))

(defun count-open (names)
  (reduce #'+ (mapcar (lambda (name) (if (prolog:prolog `(container-open ,name)) 1 0)) names)
          :initial-value 0))

(defun seal-container (&key
                         ((:object ?container))
                         ((:arms arms))
                         ((:robot-location ?robot-location))
                         ((:tries tries) (length arms))
                       &allow-other-keys)
  "Pushes a container shut, with the first arm that manages."
  (declare (type desig:object-designator ?container))
  (assert-list arms)
  (when ?robot-location
    (exe:perform (desig:an action (type navigating) (location ?robot-location))))
  (let ((tried 0)
        (result nil))
    (cpl:with-failure-handling
        (((or common-fail:manipulation-goal-not-reached
              common-fail:gripper-low-level-failure)
             (e)
           (roslisp:ros-warn (seal seal) "try ~a of ~a: ~a" tried tries e)
           (when (< tried tries)
             (cpl:retry))
           (cpl:fail 'common-fail:environment-manipulation-impossible))
         (condition (e)
           (roslisp:ros-error (seal seal) "something else went wrong: ~a" e)))
      (let ((arm (nth tried arms)))
        (incf tried)
        (setf result (push-shut ?container arm))))
    (values result tried)))

(defun assert-list (arms)
  (handler-case
      (unless (and (listp arms) arms)
        (error "no arms to seal with: ~a" arms))
    (error (e)
      (roslisp:ros-warn (seal seal) "~a" e)
      (cpl:fail 'common-fail:environment-manipulation-impossible))))
