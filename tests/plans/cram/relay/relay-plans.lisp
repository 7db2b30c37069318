(in-package :relay-plans)

(defun what-hand-holds (arm)
  "The object in that hand, as the belief state has it."
  (let ((bindings (cut:lazy-car (prolog:prolog `(cpoe:object-in-hand ?object ,arm)))))
    (when bindings
      (cut:var-value '?object bindings))))

(defun hand-of (object)
  (cut:with-vars-bound (?arm)
      (car (prolog:prolog `(cpoe:object-in-hand ,object ?arm)))
    (unless (member ?arm '(:left :right))
      (cpl:fail 'common-fail:object-unfetchable))
    ?arm))

(defun free-hands ()
  (mapcar (lambda (bindings) (cut:var-value '?arm bindings))
          (cut:force-ll (prolog:prolog `(and (rob-int:robot ?robot)
                                             (rob-int:arm ?robot ?arm)
                                             (man-int:robot-free-hand ?robot ?arm))))))

(defun named-objects (types)
  "A designator for each kind, and a note of which came first."
  (let ((number 0))
    (mapcar (lambda (?type)
              (incf number)
              (desig:make-designator :object `((:type ,?type) (:order ,number))))
            types)))

(defun take-with (?object ?arm locations)
  "Looks at the locations one after the other and takes the object at the first that has it."
  (cpl:try-each-in-order (?location locations)
    (exe:perform (desig:an action (type turning-towards) (target ?location)))
    (exe:perform (desig:an action (type perceiving) (object ?object)))
    (mob:pick-up-with ?object ?arm)
    (return ?location)))

(defun carry-both (&key
                     ((:objects objects))
                     ((:arms arms))
                     ((:from locations))
                     ((:to targets))
                     ((:stand ?stand))
                     ((:target-stand ?target-stand))
                   &allow-other-keys)
  "One thing in each hand, both to the table."
  (declare (type list objects arms locations targets))
  (exe:perform (desig:an action (type navigating) (location ?stand)))
  (when (/= (length objects) (length arms))
    (cpl:fail 'common-fail:object-unfetchable))
  (mapc (lambda (object arm)
          (roslisp:ros-info (relay carry) "~a gets ~a" arm object)
          (take-with object arm locations))
        objects arms)
  (when (free-hands)
    (cpl:fail 'common-fail:object-unfetchable))
  (exe:perform (desig:an action (type parking-arms)))
  (exe:perform (desig:an action (type navigating) (location ?target-stand)))
  (let ((left targets))
    (dolist (?object (mapcar #'desig:current-desig objects))
      (cpl:with-failure-handling
          ((common-fail:manipulation-goal-not-reached (e)
             (roslisp:ros-warn (relay place) "~a" e)
             (setf left (cdr left))
             (cpl:retry)))
        (unless left
          (cpl:fail 'common-fail:object-undeliverable))
        (mob:place-at ?object (hand-of ?object) (car left)))
      (setf left (cdr left))))
  (what-hand-holds :left))
