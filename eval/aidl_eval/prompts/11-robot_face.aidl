/// robot face
assembly robot_face {
    solid whole { todo }
    var alike = 1
    var fields = 1
    var symmetry = 1

    @note("head, face, skull / plate")
    solid head { todo }
    param eye_count = 2 in 1..9
    for i in 0..<eye_count {
        @note("eye, eye socket")
        solid eye[i] { todo }
    }
    @note("mouth, grille / grill / speaker")
    solid mouth { todo }

    param ear_count = 2 in 0..9
    for i in 0..<ear_count {
        @note("ear")
        solid ear[i] { todo }
    }

    assert len(eye) == 2, "there are two eyes"
    assert abs(eye[0].width - eye[-1].width) <= 0.1 * eye[0].width, "the eyes are of like size"
    assert abs(eye[0].center_y - eye[-1].center_y) <= 0.02 * head.height, "the eyes are level"
    assert abs((eye[0].center_x + eye[-1].center_x) / 2 - head.center_x) <= 0.05 * head.width,
        "the eyes are left and right of the middle"
    for e in eye {
        assert inside(e, head), "the eyes are in the face"
        assert e.center_y >= mouth.top, "the eyes are above the mouth"
    }
    assert no_overlap(eye[0], eye[-1]), "the eyes are apart"
    assert inside(mouth, head) and abs(mouth.center_x - head.center_x) <= 0.1 * head.width,
        "the mouth is in the middle of the face"
    for e in ear {
        assert abs(e.height - ear[0].height) <= 0.1 * e.height and abs(
            e.center_y - ear[0].center_y
        ) <= 0.1 * head.height,
            "the ears are alike and level"
    }
    assert symmetry >= 0.8, "left and right are alike"

    // of any language's drawing
    assert symmetry >= 0.85, "the silhouette is nearly the same on both sides"
    assert alike >= 2, "two outlines or more are alike"
    assert fields >= 4, "four fields or more are seen"
}
