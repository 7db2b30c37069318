;; Find the spoon in drawers that may already stand open. A drawer that hides the others is closed
;; first; what is open already is not opened again.

(def-cram-function close-drawer (?drawer)
  (when (holds (list 'drawer-open ?drawer))
    (exe:perform (desig:an action (type closing) (arm right)
                           (object (desig:an object (name ?drawer)))))))

(def-cram-function open-drawer (?drawer)
  (unless (holds (list 'drawer-open ?drawer))
    (exe:perform (desig:an action (type opening) (arm right)
                           (object (desig:an object (name ?drawer)))))))

(def-cram-function search-drawer (?drawer ?type)
  (open-drawer ?drawer)
  (exe:perform (desig:a motion (type looking)
                        (target (desig:a location (in (desig:an object (name ?drawer)))))))
  (with-failure-handling
      ((perception-low-level-failure (e)
         (roslisp:ros-info (demo) "nothing in ~a: ~a" ?drawer e)
         (return nil)))
    (exe:perform (desig:a motion (type detecting) (object (desig:an object (type ?type)))))))

(def-cram-function fetch (?type &key (arm :left))
  (let ((?found nil) (?arm arm))
    (dolist (?drawer '(d-top d-mid d-low))
      (setf ?found (search-drawer ?drawer ?type))
      (when ?found
        (exe:perform (desig:an action (type picking-up) (arm ?arm) (object ?found)))
        (return))
      (close-drawer ?drawer))
    (unless ?found (fail 'object-nowhere-to-be-found))
    ?found))

(top-level (fetch :spoon :arm :left))
