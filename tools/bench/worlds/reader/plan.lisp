;; Take the novel and have it stamped, then bring it back; the atlas goes with it where it is there.

(def-cram-function fetch-and-return (?book)
  (perform (an action (type taking) (object ?book)))
  (perform (an action (type walking) (to :desk)))
  (perform (an action (type stamping) (object ?book)))
  (perform (an action (type walking) (to :shelves)))
  (perform (an action (type returning) (object ?book))))

(def-cram-function read-books ()
  (perform (an action (type walking) (to :shelves)))
  (fetch-and-return :novel)
  (when (holds '(on-shelf atlas))
    (perform (an action (type taking) (object :atlas)))
    (perform (an action (type returning) (object :atlas)))))

(read-books)
