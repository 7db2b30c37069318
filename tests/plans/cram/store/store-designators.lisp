(in-package :store-plans)

(def-fact-group store-designators (desig:action-grounding)

  ;; What is already in a drawer stays there.
  (<- (desig:action-grounding ?action-designator (leave-it ?action-designator))
    (spec:property ?action-designator (:type :storing))
    (spec:property ?action-designator (:object ?object))
    (spec:property ?object (:location ?location))
    (man-int:location-container ?location ?_))

  (<- (desig:action-grounding ?action-designator (store ?resolved-action-designator))
    (spec:property ?action-designator (:type :storing))
    (spec:property ?action-designator (:object ?some-object))
    (desig:current-designator ?some-object ?object)
    (spec:property ?object (:type ?type))
    (lisp-fun kit:get-object-likely-locations ?type ?from)
    (-> (spec:property ?action-designator (:containers ?containers))
        (true)
        (equal ?containers (:d-low :d-mid :d-top)))
    (desig:desig-description ?action-designator ?properties)
    (append ((:type :storing) (:object ?object)) ((:containers ?containers) (:from ?from)) ?all)
    (lisp-pred identity ?properties)
    (desig:designator :action ?all ?resolved-action-designator)))

(defun leave-it (&key ((:object ?object)) &allow-other-keys)
  (roslisp:ros-info (store leave) "~a is put away" ?object)
  ?object)
