(in-package :access-plans)

(define-condition container-blocked (common-fail:environment-manipulation-impossible) ())

(defun container-above (container)
  "The drawers above this one, which hide it as long as they are open."
  (let ((names (mapcar #'identity kit:*drawers*)))
    (loop for name in names
          until (eq name container)
          collect name)))

(defun open-above (container)
  "Those of them that stand open, as far as the robot knows."
  (remove-if-not (lambda (name)
                   (prolog:prolog `(container-open ,name)))
                 (container-above container)))

(defun shut-those-above (container arm)
  (let ((?arm arm))
    (mapc (lambda (name)
            (let ((?name name))
              (roslisp:ros-info (access above) "~a is in the way" ?name)
              (exe:perform (desig:an action
                                     (type closing)
                                     (arm ?arm)
                                     (object (desig:an object (name ?name)))))))
          (open-above container))))

(defun access-container (&key
                           ((:type action-type))
                           ((:object ?container))
                           ((:arms ?arms))
                           ((:robot-location ?robot-location))
                           ((:distance ?distance) 0.4d0)
                           ((:already-open already-open))
                         &allow-other-keys)
  "Opens a container, with one arm or the other, and makes sure nothing above hides it."
  (declare (type desig:object-designator ?container)
           (type list ?arms))
  (unless (numberp ?distance)
    (error "~a is no distance for ~a" ?distance action-type))
  (cpl:with-failure-handling
      ((common-fail:navigation-high-level-failure (e)
         (declare (ignore e))
         (cpl:fail 'common-fail:environment-unreachable)))
    (exe:perform (desig:an action (type navigating) (location ?robot-location))))
  (if already-open
      (roslisp:ros-info (access access) "it is open")
      (cpl:try-in-order
        (open-with (first ?arms) ?container ?distance)
        (open-with (second ?arms) ?container ?distance)))
  (exe:perform (desig:an action (type parking-arms) (arms ?arms)))
  ?container)

(defun open-with (?arm ?container ?distance)
  (unless ?arm
    (cpl:fail 'container-blocked))
  (cpl:with-retry-counters ((tries 1))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (roslisp:ros-warn (access open) "~a: ~a" ?arm e)
           (cpl:do-retry tries
             (shut-those-above (desig:desig-prop-value ?container :name) ?arm)
             (cpl:retry))))
      (exe:perform (desig:an action
                             (type opening)
                             (arm ?arm)
                             (object ?container)
                             (distance ?distance))))))
