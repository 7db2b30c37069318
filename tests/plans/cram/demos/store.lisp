(in-package :store-plans)

(defun demo-store ()
  (let ((?bowl (desig:an object (type bowl))))
    (exe:perform (desig:an action (type storing) (object ?bowl) (containers (d-mid d-low))))
    ;; where it is now is known, so nothing is left to do
    (let ((?put-away (desig:current-desig ?bowl)))
      (exe:perform (desig:an action (type storing) (object ?put-away))))))

(demo-store)
