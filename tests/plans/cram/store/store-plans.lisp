(in-package :store-plans)

(defun describe-again (?object location)
  "The same object, described by where it is now."
  (let ((described (desig:copy-designator ?object :new-description `((:location ,location)))))
    (desig:equate ?object described)
    described))

(defun known-properties (object)
  (mapcar #'kit:plain-key (desig:properties object)))

(defun choose-container (containers)
  "The first container that is not open already; they are names."
  (find-if (lambda (name)
             (and (not (stringp name))
                  (not (prolog:prolog `(container-open ,name)))))
           containers))

(defun check-description (object)
  (unless (member :type (known-properties object))
    (error "nobody knows what ~a is" object)))

(defun store (&key
                ((:object ?object))
                ((:arm ?arm) :left)
                ((:other-arm ?other-arm) (if (eq ?arm :left) :right :left))
                ((:containers containers))
                ((:from locations))
              &allow-other-keys)
  "Puts a thing from the counter into a drawer."
  (declare (type desig:object-designator ?object))
  (check-description ?object)
  (let* ((?name (or (choose-container containers)
                    (cpl:fail 'common-fail:object-undeliverable)))
         (?container (desig:an object (type drawer) (name ?name)))
         (?inside (desig:a location (in ?container))))
    (flet ((take (?location)
             (exe:perform (desig:an action (type turning-towards) (target ?location)))
             (apply #'exe-perceive (list ?object))
             (mob:pick-up-with ?object ?arm))
           (handle (type)
             (let ((?type type))
               (exe:perform (desig:an action
                                      (type ?type)
                                      (arm ?other-arm)
                                      (object ?container))))))
      (cpl:try-each-in-order (?location locations)
        (take ?location))
      (handle :opening)
      (unwind-protect
           (progn
             (exe:perform (desig:an action
                                    (type putting-in)
                                    (arm ?arm)
                                    (object ?object)
                                    (container ?container)))
             (describe-again ?object ?inside))
        (handle :closing)))))

(defun exe-perceive (?object)
  (funcall (lambda (&rest arguments)
             (let ((?what (car arguments)))
               (exe:perform (desig:an action (type perceiving) (object ?what)))))
           ?object))
