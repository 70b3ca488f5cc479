/// mailbox
assembly mailbox {
    var pieces = 1
    var fields = 1
    var fullness = 1

    assert pieces <= 1, "the parts hold together"
    assert fields >= 3, "three fields or more are seen"
    assert fullness <= 0.98, "the silhouette is no mere rectangle"
}
